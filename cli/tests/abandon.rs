//! The end of a process that runs no destructors. A test of its own: nothing can be written in this process any more.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use rod_files::Staged;
use rod_files::output::abandon;
use std::fs;

#[test]
fn abandoned_stages_are_gone_and_what_was_there_stays() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("file"), "good").unwrap();
    let stages = ["", "new/folder"].map(|folder| {
        let staged = Staged::new(&directory.path().join(folder)).unwrap();
        staged.write("sub/file".as_ref(), |out| out.write_all(b"half")).unwrap();
        staged
    });
    assert!(!abandon(), "nothing has been published");
    let left: Vec<_> = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["file"]);
    assert_eq!(fs::read_to_string(directory.path().join("file")).unwrap(), "good");
    // dropped, they would wait for ever
    stages.into_iter().for_each(std::mem::forget);
}
