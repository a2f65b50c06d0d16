//! Files of trackers of video (DeepLabCut, SLEAP): body parts with pixels and likelihoods. `vibrissa.tracking` in Python reads them.

use super::report::{Certainty, InspectedColumn, InspectedFile, Question};
use std::io::Read;
use std::path::Path;

/// The first bytes of a file of HDF5.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Bytes that show whether a tracker wrote the file.
const START: u64 = 16;

/// Largest part of a file of HDF5 in which names are looked for, bytes.
const PART: usize = 64 << 20;
/// Least likelihood of a point that `vibrissa.tracking` takes unless told otherwise.
const LIKELIHOOD: f64 = 0.6;

/// How a scale follows from an image.
pub(super) const RULER: &str = "METRES is a known distance in the image, as on a ruler or of the pole, in m, divided by the same distance in pixels";

/// A tracker and what its file tracks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tracked {
    tracker: Tracker,
    /// Body parts or nodes in the order of the file; empty where they are not known.
    parts: Vec<String>,
    /// Animals, if the file has several.
    individuals: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tracker {
    DeepLabCut,
    Sleap,
}

impl Tracker {
    fn name(self) -> &'static str {
        match self {
            Self::DeepLabCut => "DeepLabCut",
            Self::Sleap => "SLEAP",
        }
    }
}

/// What a tracker has written, if the file is of one.
pub(super) fn tracked(path: &Path, file: &mut InspectedFile) -> Option<Tracked> {
    // what begins otherwise may be a long recording
    let mut start = Vec::new();
    std::fs::File::open(path).ok()?.take(START).read_to_end(&mut start).ok()?;
    let is_tracker = |start: &[u8]| [&b"scorer,"[..], b"track,", HDF5].iter().any(|begin| start.starts_with(begin));
    if !is_tracker(start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&start)) {
        return None;
    }
    let bytes = std::fs::read(path).ok()?;
    if bytes.starts_with(HDF5) {
        return hdf5(&bytes[..bytes.len().min(PART)], file);
    }
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.trim_start_matches('\u{feff}').lines().map(|line| line.split(',').map(str::trim));
    let first = lines.next()?.collect::<Vec<_>>();
    if first[0] == "scorer" { deeplabcut(lines, file) } else { sleap(&first, file) }
}

/// Body parts of a table of DeepLabCut, from the line below `scorer`.
fn deeplabcut<'a, L: Iterator<Item = &'a str>>(
    mut lines: impl Iterator<Item = L>,
    file: &mut InspectedFile,
) -> Option<Tracked> {
    let mut level: Vec<&str> = lines.next()?.collect();
    let mut owners: Option<Vec<&str>> = None;
    if level[0] == "individuals" {
        owners = Some(std::mem::replace(&mut level, lines.next()?.collect()));
    }
    let parts = level;
    let coords: Vec<&str> = lines.next()?.collect();
    if parts[0] != "bodyparts" || coords[0] != "coords" {
        return None;
    }
    let mut columns: Vec<(f64, f64)> = vec![(f64::INFINITY, f64::NEG_INFINITY); coords.len()];
    let mut likely = vec![0_usize; coords.len()];
    let mut frames = 0_usize;
    for cells in lines {
        let cells: Vec<&str> = cells.collect();
        if cells.len() != coords.len() {
            continue;
        }
        frames += 1;
        for (k, cell) in cells.iter().enumerate() {
            if let Ok(value) = cell.parse::<f64>() {
                columns[k] = (columns[k].0.min(value), columns[k].1.max(value));
                likely[k] += usize::from(value >= LIKELIHOOD);
            }
        }
    }
    file.fact("frames", frames.to_string());
    for k in (1..coords.len()).filter(|k| coords[*k] == "likelihood") {
        let part = parts.get(k).copied().unwrap_or_default();
        let owner =
            owners.as_ref().and_then(|owners| owners.get(k)).map_or_else(String::new, |owner| format!("{owner} "));
        let share = 100 * likely[k] / frames.max(1);
        file.fact(
            "body part",
            format!("{owner}`{part}`: likelihood of at least {LIKELIHOOD} in {share} % of the frames"),
        );
    }
    file.columns = (0..coords.len()).map(|k| column(&parts, &coords, k, columns[k])).collect();
    let distinct = |level: &[&str]| {
        let mut names: Vec<String> = Vec::new();
        for name in level.iter().skip(1).filter(|name| !name.is_empty()) {
            if names.iter().all(|known| known != name) {
                names.push((*name).to_owned());
            }
        }
        names
    };
    let individuals = owners.map_or_else(Vec::new, |owners| distinct(&owners));
    Some(Tracked { tracker: Tracker::DeepLabCut, parts: distinct(&parts), individuals })
}

fn column(parts: &[&str], coords: &[&str], k: usize, (least, most): (f64, f64)) -> InspectedColumn {
    let coord = coords[k];
    let (meaning, unit) = match coord {
        "coords" => ("frame", None),
        "likelihood" => ("likelihood", None),
        _ => (coord, Some("pixels".to_owned())),
    };
    let part = parts.get(k).copied().unwrap_or_default();
    InspectedColumn {
        name: if k == 0 { "frame".to_owned() } else { format!("{part} {coord}") },
        meaning: Some(meaning.to_owned()),
        meaning_certainty: Certainty::Sure,
        meaning_why: "the lines of the header".to_owned(),
        unit,
        unit_certainty: Certainty::Sure,
        unit_why: String::new(),
        least: least.is_finite().then_some(least),
        most: most.is_finite().then_some(most),
        noise: None,
        behaviour: None,
    }
}

/// Nodes of a table of SLEAP: `track,frame_idx,instance.score,node.x,node.y,node.score`.
fn sleap(names: &[&str], file: &mut InspectedFile) -> Option<Tracked> {
    if !["track", "frame_idx"].iter().all(|name| names.contains(name)) {
        return None;
    }
    let parts: Vec<String> = names.iter().filter_map(|name| name.strip_suffix(".x")).map(str::to_owned).collect();
    if parts.is_empty() {
        return None;
    }
    file.fact("nodes", parts.join(", "));
    Some(Tracked { tracker: Tracker::Sleap, parts, individuals: Vec::new() })
}

/// The tracker behind a file of HDF5, by the names that it gives its parts. The file is not read further: that takes a library of HDF5.
fn hdf5(bytes: &[u8], file: &mut InspectedFile) -> Option<Tracked> {
    let has = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
    let tracker = if has(b"bodyparts") || has(b"df_with_missing") {
        Tracker::DeepLabCut
    } else if has(b"node_names") && has(b"tracks") {
        Tracker::Sleap
    } else {
        return None;
    };
    file.fact("format", "HDF5, of which only the names of its parts are looked at");
    Some(Tracked { tracker, parts: Vec::new(), individuals: Vec::new() })
}

impl Tracked {
    /// What the file is.
    pub fn kind(&self) -> String {
        format!("tracked points of {}, in pixels", self.tracker.name())
    }

    /// Asks for what no file of a tracker states.
    pub fn ask(&self, file: &mut InspectedFile) {
        let parts = if self.parts.is_empty() { "which the file names".to_owned() } else { self.parts.join(", ") };
        file.questions.push(Question {
            text: format!("which body parts are on one rod, from the base to the tip? Here they are {parts}"),
            answers: vec!["their names, in this order, in the list of the command".to_owned()],
        });
        file.questions.push(Question {
            text: "how long is a pixel? The file does not state it".to_owned(),
            answers: vec![format!("scale=METRES in the command; {RULER}")],
        });
        if self.individuals.len() > 1 {
            file.questions.push(Question {
                text: format!("which animal? The file has {}", self.individuals.join(", ")),
                answers: self
                    .individuals
                    .iter()
                    .map(|name| format!("individual={} in the command", python(name)))
                    .collect(),
            });
        }
    }

    /// The commands that make a table of points, and find the forces.
    pub fn commands(&self, path: &Path, rod: &str) -> [Vec<String>; 2] {
        let name = path.display().to_string();
        let points = format!("{}_points.csv", path.file_stem().unwrap_or_default().to_string_lossy());
        let parts: Vec<String> = self.parts.iter().map(|part| python(part)).collect();
        let list = if parts.is_empty() { "BASE, ..., TIP".to_owned() } else { parts.join(", ") };
        let individual = match &self.individuals[..] {
            [] | [_] => "",
            _ => ", individual=NAME",
        };
        let reader = match self.tracker {
            Tracker::DeepLabCut => "read_deeplabcut",
            Tracker::Sleap => "read_sleap",
        };
        let code = format!(
            "from vibrissa import tracking; tracking.{reader}({}, [{list}], scale=METRES{individual}).write_csv({})",
            python(&name),
            python(&points)
        );
        let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
        [words(&["python3", "-c", &code]), words(&["vibrissa", "forces", &points, "--rod", rod])]
    }
}

/// A text in Python.
fn python(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looked_at(name: &str, bytes: &[u8]) -> (Option<Tracked>, InspectedFile) {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let mut file = InspectedFile::default();
        (tracked(&path, &mut file), file)
    }

    #[test]
    fn trackers_are_recognized_by_their_headers() {
        let text = "scorer,net,net,net,net,net,net\nbodyparts,base,base,base,tip,tip,tip\ncoords,x,y,likelihood,x,y,likelihood\n\
                    0,1,2,0.9,3,4,0.1\n1,1,2,0.9,3,4,0.9\n";
        let (found, file) = looked_at("a.csv", text.as_bytes());
        let found = found.unwrap();
        assert_eq!(found.parts, ["base", "tip"]);
        assert!(
            file.facts.iter().any(|fact| fact.found == "`tip`: likelihood of at least 0.6 in 50 % of the frames"),
            "{file:?}"
        );
        let [python, forces] = found.commands("a b.csv".as_ref(), "rod.toml");
        assert!(python[2].contains("read_deeplabcut(\"a b.csv\", [\"base\", \"tip\"], scale=METRES)"), "{python:?}");
        assert_eq!(forces[2], "a b_points.csv");
        let several = text.replacen("bodyparts", "individuals,m1,m1,m1,m2,m2,m2\nbodyparts", 1);
        assert_eq!(looked_at("a.csv", several.as_bytes()).0.unwrap().individuals, ["m1", "m2"]);
        let sleap = "track,frame_idx,instance.score,a.x,a.y,a.score\n,0,1,2,3,1\n";
        assert_eq!(looked_at("a.csv", sleap.as_bytes()).0.unwrap().parts, ["a"]);
        let hdf5 = looked_at("a.h5", b"\x89HDF\r\n\x1a\n...df_with_missing...").0.unwrap();
        assert_eq!(hdf5.kind(), "tracked points of DeepLabCut, in pixels");
        for other in ["scorer,a\nb,c\n", "t,x0\n0,1\n", "", "\u{89}HDF"] {
            assert_eq!(looked_at("a.csv", other.as_bytes()).0, None, "{other}");
        }
    }
}
