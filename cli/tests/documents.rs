//! The scenes of the documentation and of the repository.

use std::fs;
use std::path::{Path, PathBuf};
use vibrissa::contour::description::Shape;
use vibrissa_cli::AnyScene;

fn scenes(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some_and(|extension| extension == "toml")).collect()
}

#[test]
fn every_scene_can_be_read_and_drawn() {
    let files = [scenes("scenes"), scenes("docs/shapes")].concat();
    assert!(files.len() > 9 + Shape::NAMES.len());
    for file in files {
        let profiles = match AnyScene::read(&file).unwrap_or_else(|error| panic!("{error}")) {
            AnyScene::Uniform(scene) => scene.profiles(None, None),
            AnyScene::Mounted(scene) => scene.profiles(None, None),
            AnyScene::Guided(scene) => scene.profiles(None, None),
        };
        assert!(!profiles.unwrap().is_empty(), "{}", file.display());
    }
}

#[test]
fn every_shape_has_a_section_and_a_small_picture() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let page = fs::read_to_string(docs.join("shapes.md")).unwrap();
    for name in Shape::NAMES {
        assert!(page.contains(&format!("\n## {name}\n")), "{name}");
        assert!(page.contains(&format!("][shapes/{name}.svg]\n")), "{name}");
        assert!(fs::metadata(docs.join(format!("shapes/{name}.svg"))).unwrap().len() < 60_000, "{name}");
        let scene = fs::read_to_string(docs.join(format!("shapes/{name}.toml"))).unwrap();
        assert!(scene.contains(&format!("shape = \"{name}\"")), "{name}");
    }
}
