//! The scenes of the documentation and of the repository.

use rod_files::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use vibrissa::contour::description::Shape;

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
        let profiles = Scene::read(&file).unwrap_or_else(|error| panic!("{error}")).profiles(None, None);
        assert!(!profiles.unwrap().is_empty(), "{}", file.display());
    }
}

/// The blocks of TOML on the pages of rods and whiskers, with an object and a path behind them.
#[test]
fn the_rods_of_the_documentation_can_be_read() {
    let rest = "[[contour.piece]]\nshape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 50.0\n\
                [sweep]\nfrom = [0.08, -0.04]\nto = [0.0, -0.04]\nangle = 90.0\nstep = 1e-3\n";
    for (page, count) in [("rods.md", 4), ("whiskers.md", 1)] {
        let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(page)).unwrap();
        let blocks: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|block| block.split("```").next()).collect();
        assert_eq!(blocks.len(), count, "{page}");
        for block in blocks {
            let scene = Scene::parse(page.as_ref(), &format!("{block}\n{rest}"))
                .unwrap_or_else(|error| panic!("{error}\n{block}"));
            assert!(
                !(scene.rod.uniform().is_some() && scene.rod.is_held_rigidly()) && scene.warnings.is_empty(),
                "{block}"
            );
        }
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
