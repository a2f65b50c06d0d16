//! The files that a scene names.

use super::document::SceneDocument;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Files of points, drawings and shapes, and those that a file of shapes names in turn. Relative ones are looked for in the
/// directory of the file that names them.
pub(super) fn named_files(document: &SceneDocument, directory: &Path) -> Vec<PathBuf> {
    let SceneDocument { tables, contour, objects } = document;
    let pieces = contour.iter().chain(objects.iter().flatten()).filter_map(|piece| piece.file());
    let mut files: Vec<PathBuf> = pieces.map(|file| directory.join(file)).collect();
    let tables = tables.contour.iter().chain(&tables.object);
    for file in tables.filter_map(|table| table.get_ref().file.as_ref()).map(|file| directory.join(file.get_ref())) {
        let shapes = std::fs::read(&file).ok().and_then(|text| serde_json::from_slice::<Value>(&text).ok());
        let beside = file.parent().unwrap_or(directory).to_path_buf();
        if let Some(shapes) = shapes {
            in_shapes(&shapes, &beside, &mut files);
        }
        files.push(file);
    }
    files
}

fn in_shapes(value: &Value, directory: &Path, files: &mut Vec<PathBuf>) {
    match value {
        Value::Object(fields) => {
            files.extend(fields.get("file").and_then(Value::as_str).map(|file| directory.join(file)));
            fields.values().for_each(|value| in_shapes(value, directory, files));
        }
        Value::Array(values) => values.iter().for_each(|value| in_shapes(value, directory, files)),
        _ => {}
    }
}
