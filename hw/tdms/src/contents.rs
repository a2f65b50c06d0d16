//! The contents of a file: groups, channels, their properties, and the places of their values.

use super::data_type::DataType;
use super::property::TdmsProperties;
use super::run::{Run, Series};
use std::collections::HashMap;

#[derive(Clone, Debug, Default)]
pub(super) struct Contents {
    pub root: TdmsProperties,
    pub groups: Vec<GroupContents>,
    pub channels: Vec<ChannelContents>,
    names: HashMap<String, usize>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct GroupContents {
    pub name: String,
    pub properties: TdmsProperties,
    /// By name; and in their order, as indices of all channels.
    pub by_name: HashMap<String, usize>,
    pub channels: Vec<usize>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct ChannelContents {
    pub group: usize,
    pub name: String,
    pub properties: TdmsProperties,
    pub series: Vec<Series>,
}

/// Whose properties and values.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Root,
    Group(usize),
    Channel(usize),
}

impl Contents {
    /// The object of a path, which is added; `None` if the path is invalid.
    pub fn add(&mut self, path: &str) -> Option<Target> {
        Some(match parts(path)?.as_slice() {
            [] => Target::Root,
            [group] => Target::Group(self.group(group)),
            [group, channel] => {
                let group = self.group(group);
                let index = self.channels.len();
                let parent = self.groups.get_mut(group)?;
                // two spellings of a path are one channel
                let index = *parent.by_name.entry(channel.clone()).or_insert(index);
                if index == self.channels.len() {
                    parent.channels.push(index);
                    self.channels.push(ChannelContents { group, name: channel.clone(), ..ChannelContents::default() });
                }
                Target::Channel(index)
            }
            _ => return None,
        })
    }

    fn group(&mut self, name: &str) -> usize {
        if let Some(&index) = self.names.get(name) {
            return index;
        }
        self.groups.push(GroupContents { name: name.to_owned(), ..GroupContents::default() });
        self.names.insert(name.to_owned(), self.groups.len() - 1);
        self.groups.len() - 1
    }

    pub fn properties_mut(&mut self, target: Target) -> Option<&mut TdmsProperties> {
        match target {
            Target::Root => Some(&mut self.root),
            Target::Group(index) => self.groups.get_mut(index).map(|group| &mut group.properties),
            Target::Channel(index) => self.channels.get_mut(index).map(|channel| &mut channel.properties),
        }
    }

    /// More values of an object.
    ///
    /// # Errors
    /// The fault if they contradict the ones before.
    pub fn add_run(&mut self, target: Target, id: Option<u32>, run: Run) -> Result<(), &'static str> {
        /// Each is looked up among all of a channel.
        const MOST: usize = 64;
        // values of a group or of the root have no place to go, but took their bytes
        let Target::Channel(index) = target else { return Ok(()) };
        let Some(ChannelContents { series, .. }) = self.channels.get_mut(index) else { return Ok(()) };
        let count = series.len();
        match series.iter_mut().find(|series| series.id == id) {
            Some(series) if series.runs.first().is_some_and(|first| kind(first.data_type) != kind(run.data_type)) => {
                return Err("a channel changes between numbers and texts");
            }
            Some(series) => series.push(run),
            None if count >= MOST => return Err("a channel has more than 64 DAQmx scalers"),
            None => series.push(Series { id, count: run.count, runs: vec![run] }),
        }
        Ok(())
    }

    pub fn find(&self, group: &str, channel: &str) -> Option<usize> {
        self.groups.get(*self.names.get(group)?)?.by_name.get(channel).copied()
    }

    pub fn find_group(&self, name: &str) -> Option<usize> {
        self.names.get(name).copied()
    }
}

/// Types of one kind can follow each other in a channel.
fn kind(data_type: DataType) -> Option<DataType> {
    (!data_type.is_number()).then_some(data_type)
}

/// The names in a path: none of `/`, one of `/'group'`, two of `/'group'/'channel'`; a quote in a name is doubled.
fn parts(path: &str) -> Option<Vec<String>> {
    let mut parts = Vec::new();
    if path == "/" {
        return Some(parts);
    }
    let mut rest = path;
    while !rest.is_empty() {
        rest = rest.strip_prefix("/'")?;
        let mut name = String::new();
        loop {
            let (before, after) = rest.split_once('\'')?;
            name.push_str(before);
            match after.strip_prefix('\'') {
                Some(after) => {
                    name.push('\'');
                    rest = after;
                }
                None => {
                    rest = after;
                    break;
                }
            }
        }
        parts.push(name);
        if parts.len() > 2 {
            return None;
        }
    }
    (!parts.is_empty()).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths() {
        assert_eq!(parts("/"), Some(vec![]));
        assert_eq!(parts("/'a'"), Some(vec!["a".into()]));
        assert_eq!(parts("/'it''s'/'a/b'"), Some(vec!["it's".into(), "a/b".into()]));
        assert_eq!(parts("/''/''''"), Some(vec!["".into(), "'".into()]));
        for path in ["", "a", "/a", "/'a", "/'a''", "/'a'b", "/'a'/'b'/'c'", "//"] {
            assert_eq!(parts(path), None, "{path}");
        }
    }
}
