//! The data of a path in an SVG drawing: the seam to `roxmltree`.

use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

use super::{FileError, SvgError};

/// The data (attribute `d`) of the only `path` element of an SVG file, or of the one with this id.
///
/// ```
/// let directory = std::env::temp_dir().join("rod-contours-svg");
/// std::fs::create_dir_all(&directory)?;
/// let file = directory.join("step.svg");
/// std::fs::write(&file, r#"<svg xmlns="http://www.w3.org/2000/svg"><g><path d="M0 0 H10 V-5 H20"/></g></svg>"#)?;
/// assert_eq!(rod_contours::file::svg_data(&file, None)?, "M0 0 H10 V-5 H20");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`FileError::Unreadable`], [`FileError::Malformed`], or [`FileError::Svg`] for no path, several without an id, none
/// of this id, or a transform.
pub fn data(file: &Path, id: Option<&str>) -> Result<String, FileError> {
    let text = super::text(file)?;
    // Drawing programs write a document type, which has no part in the drawing.
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options).map_err(|error| FileError::Malformed {
        file: file.to_path_buf(),
        line: u64::from(error.pos().row),
        message: error.to_string(),
    })?;
    found(&document, id).map_err(|source| FileError::Svg { file: file.to_path_buf(), source })
}

fn found(document: &Document<'_>, id: Option<&str>) -> Result<String, SvgError> {
    let paths: Vec<Node<'_, '_>> =
        document.descendants().filter(|node| node.is_element() && node.tag_name().name() == "path").collect();
    let ids = || {
        let ids: Vec<_> = paths.iter().map(|path| path.attribute("id").unwrap_or("one without an id")).collect();
        ids.join(", ")
    };
    let path = match (id, &paths[..]) {
        (_, []) => return Err(SvgError::NoPath),
        (Some(id), _) => paths
            .iter()
            .find(|path| path.attribute("id") == Some(id))
            .ok_or_else(|| SvgError::NoSuchPath { id: id.to_owned(), ids: ids() })?,
        (None, [path]) => path,
        (None, _) => return Err(SvgError::SeveralPaths { count: paths.len(), ids: ids() }),
    };
    if let Some(element) = path.ancestors().find(|element| element.has_attribute("transform")) {
        return Err(SvgError::Transform {
            element: element.tag_name().name().to_owned(),
            transform: element.attribute("transform").unwrap_or_default().to_owned(),
        });
    }
    path.attribute("d").map(str::to_owned).ok_or(SvgError::NoData)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(body: &str, id: Option<&str>) -> Result<String, String> {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("drawing.svg");
        std::fs::write(&file, format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{body}</svg>")).unwrap();
        data(&file, id).map_err(|error| error.to_string().replace(directory.path().to_str().unwrap(), ""))
    }

    #[test]
    fn one_path_of_several() {
        let two = r#"<path id="a" d="M0 0"/><g><path id="b" d="M1 1"/></g>"#;
        assert_eq!(read(two, Some("b")).unwrap(), "M1 1");
        assert_eq!(
            read(two, None).unwrap_err(),
            "/drawing.svg: 2 `path` elements (a, b), expected one; name one of them with `id`"
        );
        assert_eq!(
            read(two, Some("c")).unwrap_err(),
            "/drawing.svg: no `path` element with the id \"c\", expected one of: a, b"
        );
    }

    #[test]
    fn drawings_without_a_path() {
        assert!(read("<circle r=\"1\"/>", None).unwrap_err().starts_with("/drawing.svg: no `path` element"));
        assert!(read("<path/>", None).unwrap_err().contains("has no attribute `d`"));
        assert!(read("<path", None).unwrap_err().starts_with("/drawing.svg:2: "));
        let moved = r#"<g transform="scale(2)"><path d="M0 0"/></g>"#;
        let error = read(moved, None).unwrap_err();
        assert!(error.contains("the element `g`") && error.contains("the transform \"scale(2)\""), "{error}");
    }
}
