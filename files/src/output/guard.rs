//! What an output may not replace.

use super::OutputError;
use std::fs;
use std::path::{Path, PathBuf};

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
