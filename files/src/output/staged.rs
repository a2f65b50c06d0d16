//! A directory of results that appears as a whole or not at all.

use super::stages::{self, Registration};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

/// Why results cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The directory cannot be made or written to.
    #[error("cannot write into the directory {}: {source}; name another one", directory.display())]
    Directory {
        /// Which directory.
        directory: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file is where a directory is to be.
    #[error("{} is a file, expected a directory; name another one", file.display())]
    NoDirectory {
        /// Which file.
        file: PathBuf,
    },
    /// A name that is none for a table.
    #[error("{} is no name for a CSV file, expected one that does not end in .svg, the name of the drawing", file.display())]
    Name {
        /// The name.
        file: PathBuf,
    },
    /// A directory is where a file is to be.
    #[error("{} is a directory, expected a file", directory.display())]
    IsDirectory {
        /// Which directory.
        directory: PathBuf,
    },
    /// A path that leads to no file.
    #[error("{} is no name for a file; name one with --file", file.display())]
    NoFile {
        /// The path.
        file: PathBuf,
    },
    /// There is a file of this name, which is kept.
    #[error("{} exists and is kept; name another file", file.display())]
    Exists {
        /// Which file.
        file: PathBuf,
    },
    /// An output would replace something that is no plain file.
    #[error("{} is {what} and is not replaced; name another file or directory", file.display())]
    Special {
        /// Its name.
        file: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// An output would replace an input.
    #[error("{} is read by this command and would be overwritten; name another file or directory", file.display())]
    Input {
        /// Which file.
        file: PathBuf,
    },
    /// Standard output does not take the table.
    #[error("cannot write to standard output: {0}")]
    Standard(#[source] io::Error),
    /// A file cannot be written.
    #[error("cannot write {}: {source}", file.display())]
    File {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Files written beside where they belong, and moved there by [`publish`](Self::publish) once all of them are complete.
/// Dropped before, it leaves what was there untouched. [`abandon`](super::abandon) does that for all of a process.
#[derive(Debug)]
pub struct Staged {
    target: PathBuf,
    /// Files that must not be replaced.
    inputs: Vec<PathBuf>,
    /// Files of an earlier run that must not stay.
    obsolete: Mutex<Vec<PathBuf>>,
    stage: TempDir,
    // after the stage, in which order they are dropped
    _registration: Registration,
}

impl Staged {
    /// Files for the directory `target`, which is made if it is missing.
    ///
    /// # Errors
    /// [`OutputError::NoDirectory`], [`OutputError::Directory`].
    pub fn new(target: &Path) -> Result<Self, OutputError> {
        if let Some(file) = target.ancestors().find(|there| there.is_file()) {
            return Err(OutputError::NoDirectory { file: file.to_path_buf() });
        }
        let mut stages = stages::lock();
        let missing = |directory: &&Path| !directory.as_os_str().is_empty() && !directory.exists();
        let made = target.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        let stage = || {
            fs::create_dir_all(target)?;
            // Within the target: a rename never crosses from one file system to another.
            tempfile::Builder::new().prefix(".vibrissa-").tempdir_in(target)
        };
        let stage = stage().map_err(|source| OutputError::Directory { directory: target.to_path_buf(), source })?;
        let _registration = stages.open(stage.path(), made);
        Ok(Self { target: target.to_path_buf(), inputs: Vec::new(), obsolete: Mutex::default(), stage, _registration })
    }

    /// The same, but it replaces none of these files.
    #[must_use]
    pub fn keeping(self, inputs: Vec<PathBuf>) -> Self {
        Self { inputs, ..self }
    }

    /// Files for the directory of the file `out`, and the name of that one there.
    ///
    /// # Errors
    /// [`OutputError::IsDirectory`], [`OutputError::NoFile`], and those of [`new`](Self::new).
    pub fn of_file(out: &Path) -> Result<(Self, &Path), OutputError> {
        if out.is_dir() || out.as_os_str().as_encoded_bytes().ends_with(b"/") {
            return Err(OutputError::IsDirectory { directory: out.to_path_buf() });
        }
        let name = out.file_name().map(Path::new).ok_or_else(|| OutputError::NoFile { file: out.to_path_buf() })?;
        check_output(out, &[])?;
        // The directory of a bare name is the empty path, which cannot be made.
        let directory = out.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(".".as_ref());
        Ok((Self::new(directory)?, name))
    }

    /// Writes one file; `name` may lead through folders.
    ///
    /// # Errors
    /// [`OutputError::File`], [`OutputError::Special`], [`OutputError::Input`].
    pub fn write(
        &self,
        name: &Path,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        check_output(&self.target.join(name), &self.inputs)?;
        let file = self.stage.path().join(name);
        let create = || {
            let _held = stages::lock();
            if let Some(folder) = file.parent() {
                fs::create_dir_all(folder)?;
            }
            File::create(&file)
        };
        let write = || {
            let mut out = BufWriter::new(create()?);
            content(&mut out)?;
            out.flush()
        };
        write().map_err(|source| OutputError::File { file: self.target.join(name), source })
    }

    /// Has a file go that an earlier run may have left; `name` may lead through folders.
    ///
    /// # Errors
    /// [`OutputError::Special`], [`OutputError::Input`].
    pub fn remove(&self, name: &Path) -> Result<(), OutputError> {
        let file = self.target.join(name);
        check_output(&file, &self.inputs)?;
        self.obsolete.lock().unwrap_or_else(PoisonError::into_inner).push(file);
        Ok(())
    }

    /// Moves all files to where they belong, each in one stroke over the one that was there.
    ///
    /// # Errors
    /// [`OutputError::File`]; those moved before it stay.
    pub fn publish(self) -> Result<(), OutputError> {
        let obsolete = std::mem::take(&mut *self.obsolete.lock().unwrap_or_else(PoisonError::into_inner));
        for file in obsolete {
            match fs::remove_file(&file) {
                Err(source) if source.kind() != io::ErrorKind::NotFound => {
                    return Err(OutputError::File { file, source });
                }
                _ => {}
            }
        }
        // let go before `self`, which takes it again when it is dropped
        let mut stages = stages::lock();
        stages.published = true;
        publish(self.stage.path(), &self.target).map_err(|(file, source)| OutputError::File { file, source })
    }
}

fn publish(stage: &Path, target: &Path) -> Result<(), (PathBuf, io::Error)> {
    let at_target = |source| (target.to_path_buf(), source);
    fs::create_dir_all(target).map_err(at_target)?;
    for entry in fs::read_dir(stage).map_err(at_target)? {
        let entry = entry.map_err(at_target)?;
        let (from, to) = (entry.path(), target.join(entry.file_name()));
        if from.is_dir() {
            publish(&from, &to)?;
        } else {
            fs::rename(&from, &to).map_err(|source| (to, source))?;
        }
    }
    Ok(())
}

/// Whether an output may be written to `file`: a new name, or a plain file that is none of the `inputs`.
///
/// # Errors
/// [`OutputError::Special`] for links, devices and pipes, [`OutputError::Input`].
pub fn check_output(file: &Path, inputs: &[PathBuf]) -> Result<(), OutputError> {
    let Ok(there) = fs::symlink_metadata(file) else { return Ok(()) };
    if !there.is_file() && !there.is_dir() {
        let what = if there.is_symlink() { "a link" } else { "a device or a pipe" };
        return Err(OutputError::Special { file: file.to_path_buf(), what });
    }
    let Ok(same) = file.canonicalize() else { return Ok(()) };
    if inputs.iter().any(|input| input.canonicalize().is_ok_and(|input| input == same)) {
        return Err(OutputError::Input { file: file.to_path_buf() });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fails_half_way_leaves_the_good_file() {
        let dir = tempfile::tempdir().unwrap();
        let good = dir.path().join("folder/file");
        let staged = Staged::new(dir.path()).unwrap();
        staged.write("folder/file".as_ref(), |out| out.write_all(b"good")).unwrap();
        assert!(!good.exists());
        staged.publish().unwrap();
        assert_eq!(fs::read(&good).unwrap(), b"good");

        let staged = Staged::new(dir.path()).unwrap();
        staged.remove("folder/file".as_ref()).unwrap();
        drop(staged);
        assert!(good.exists());

        let staged = Staged::new(dir.path()).unwrap();
        let failure = staged.write("folder/file".as_ref(), |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        let message = failure.unwrap_err().to_string();
        assert!(message.contains("file: disk full"), "{message}");
        drop(staged);
        assert_eq!(fs::read(&good).unwrap(), b"good");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "the stage is gone");

        let staged = Staged::new(dir.path()).unwrap();
        ["folder/file", "never there"].into_iter().for_each(|name| staged.remove(name.as_ref()).unwrap());
        staged.publish().unwrap();
        assert!(!good.exists());
    }

    #[test]
    fn directories_made_for_nothing_go_again() {
        let dir = tempfile::tempdir().unwrap();
        let staged = Staged::new(&dir.path().join("a/b")).unwrap();
        staged.write("file".as_ref(), |out| out.write_all(b"half")).unwrap();
        assert!(dir.path().join("a/b").exists());
        drop(staged);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);

        fs::create_dir(dir.path().join("a")).unwrap();
        drop(Staged::new(&dir.path().join("a/b")).unwrap());
        assert!(dir.path().join("a").exists(), "what was there before stays");
    }

    #[test]
    fn an_input_by_another_name_is_seen() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("a.csv");
        fs::write(&file, "").unwrap();
        fs::create_dir(directory.path().join("sub")).unwrap();
        let other = directory.path().join("sub/../a.csv");
        assert!(matches!(check_output(&other, std::slice::from_ref(&file)), Err(OutputError::Input { .. })));
        assert!(check_output(&file, &[directory.path().join("b.csv")]).is_ok());
        assert!(check_output(&directory.path().join("new.csv"), &[file]).is_ok());
    }
}
