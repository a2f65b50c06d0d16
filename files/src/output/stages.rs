//! The staging directories that this process has open, for an end of it that runs no destructors.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static STAGES: Mutex<Stages> = Mutex::new(Stages { open: Vec::new(), published: false });

/// Held while files are made or moved: [`abandon`] waits until that is done.
pub(super) struct Stages {
    open: Vec<Open>,
    /// Whether any results have been moved to where they belong.
    pub published: bool,
}

struct Open {
    stage: PathBuf,
    /// Directories that were made for the results, the deepest first.
    made: Vec<PathBuf>,
}

impl Open {
    /// Removes the directories that nothing came into.
    fn remove_made(&self) {
        for directory in &self.made {
            if fs::remove_dir(directory).is_err() {
                break;
            }
        }
    }
}

pub(super) fn lock() -> MutexGuard<'static, Stages> {
    STAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A staging directory as long as it is open. Dropped after the directory is gone, it takes those away that were made for
/// results which did not come.
#[derive(Debug)]
pub(super) struct Registration(PathBuf);

impl Stages {
    pub fn open(&mut self, stage: &Path, made: Vec<PathBuf>) -> Registration {
        self.open.push(Open { stage: stage.to_path_buf(), made });
        Registration(stage.to_path_buf())
    }
}

impl Drop for Registration {
    fn drop(&mut self) {
        let mut stages = lock();
        if let Some(index) = stages.open.iter().position(|open| open.stage == self.0) {
            stages.open.swap_remove(index).remove_made();
        }
    }
}

/// Removes all staging directories, and keeps this process from making or publishing any file from here on: a thread that
/// tries waits for ever. For a process that is about to exit. Returns whether results were published before.
pub fn abandon() -> bool {
    let stages = lock();
    for open in &stages.open {
        let _ = fs::remove_dir_all(&open.stage);
        open.remove_made();
    }
    let published = stages.published;
    // never unlocked
    std::mem::forget(stages);
    published
}
