//! Objects: contours of pieces, put where they stand.

use super::document::{ObjectTable, SceneTables};
use super::shape::PieceTable;
use crate::toml_file::Fault;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use vibrissa::Composite;
use vibrissa::contour::description::Pieces;
use vibrissa::contour::{ContourError, Motion, SelfCrossing, file};

/// All objects of a scene in order: `[contour]`, then every `[[object]]`.
pub(super) fn all(
    tables: &SceneTables,
    contour: &[PieceTable],
    objects: &[Vec<PieceTable>],
    directory: &Path,
) -> Result<Vec<Composite>, Fault> {
    let own = tables.contour.iter().map(|table| (table, contour));
    let others = tables.object.iter().zip(objects.iter().map(Vec::as_slice));
    let objects = own.chain(others).map(|(table, pieces)| object(table, pieces, directory));
    let objects = objects.collect::<Result<Vec<_>, _>>()?;
    if objects.is_empty() {
        return Err(Fault::new(
            0..0,
            "missing field `contour`, expected one [contour], or an [[object]] for each object",
        ));
    }
    Ok(objects)
}

fn object(table: &Spanned<ObjectTable>, pieces: &[PieceTable], directory: &Path) -> Result<Composite, Fault> {
    let at = table.span();
    let ObjectTable { reversed, hollow, file, .. } = table.get_ref();
    let motion = motion(table.get_ref())?;
    let contour = match (file, pieces) {
        (None, []) => return Err(Fault::new(at, "neither pieces nor a file, expected at least one piece or a file")),
        (Some(file), [_, ..]) => {
            return Err(Fault::new(file.span(), "given beside pieces, expected either pieces or a file"));
        }
        (Some(file), []) => from_file(file, directory)?,
        (None, pieces) => composite_of(&at, pieces, directory)?,
    };
    let contour = contour.moved(motion).map_err(|error| Fault::new(at.clone(), error.to_string()))?;
    let contour = if *reversed { contour.reversed() } else { contour };
    check_orientation(contour, hollow.as_ref(), at)
}

fn from_file(file: &Spanned<std::path::PathBuf>, directory: &Path) -> Result<Composite, Fault> {
    let path = directory.join(file.get_ref());
    let contour = file::contour(&path).map_err(|error| Fault::new(file.span(), error.to_string()))?;
    match crossing(&contour, "piece") {
        Some(error) => Err(Fault::new(file.span(), format!("{}: {error}", path.display()))),
        None => Ok(contour),
    }
}

fn composite_of(at: &Range<usize>, pieces: &[PieceTable], directory: &Path) -> Result<Composite, Fault> {
    let mut shapes = Pieces::new();
    // To which piece of the file each shape belongs, and which of how many of that piece it is.
    let mut origins = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let contours = piece.contours(directory)?;
        let count = contours.len();
        origins.extend((1..=count).map(|number| Origin { piece: index, number, count }));
        shapes.extend(contours);
    }
    let fault = |error: ContourError| {
        let (blamed, other) = faulty_pieces(&error);
        let origin = |number: Option<usize>| origins.get(number?.checked_sub(1)?);
        let span = origin(blamed).and_then(|origin| pieces.get(origin.piece)).map_or(at, |piece| &piece.span);
        let mut message = error.to_string();
        if origins.len() > pieces.len() && pieces.len() > 1 {
            let mut numbers: Vec<usize> = [other, blamed].into_iter().flatten().collect();
            numbers.sort_unstable();
            numbers.dedup();
            for number in numbers {
                if let Some(Origin { piece, number: part, count }) = origin(Some(number)) {
                    let what = if pieces[*piece].has_edges() { "edge" } else { "part" };
                    let part = if *count > 1 {
                        format!("{what} {part} of piece[{}]", piece + 1)
                    } else {
                        format!("piece[{}]", piece + 1)
                    };
                    message += &format!("; number {number} here is {part}");
                }
            }
        }
        Fault::new(span.clone(), message)
    };
    let what = if matches!(pieces, [piece] if piece.has_edges()) { "edge" } else { "piece" };
    let edges = |error| match error {
        ContourError::Crosses { first, second, x, y, .. } => ContourError::Crosses { what, first, second, x, y },
        error => error,
    };
    let contour = Composite::joined(shapes).map_err(|error| fault(edges(error)))?;
    match crossing(&contour, what) {
        Some(error) => Err(fault(error)),
        None => Ok(contour),
    }
}

/// Where a piece of a contour comes from.
struct Origin {
    /// Index of the piece in the file.
    piece: usize,
    /// Which of that piece's, from 1.
    number: usize,
    /// How many that piece has.
    count: usize,
}

/// The number of the piece to be blamed, and of the other one, where there is one: the library counts from 1. Of two
/// that do not fit it is the second one that was put in the wrong place.
fn faulty_pieces(error: &ContourError) -> (Option<usize>, Option<usize>) {
    match *error {
        ContourError::NoCrossing { piece, next, .. } | ContourError::Apart { piece, next, .. } => {
            (Some(next), Some(piece))
        }
        ContourError::Crosses { first, second, .. } => (Some(second), Some(first)),
        ContourError::Hidden { piece, next, .. } => (Some(piece), Some(next)),
        ContourError::NoEnd { piece, neighbour } => (Some(piece), Some(neighbour)),
        ContourError::PieceRange { piece, .. } => (Some(piece), None),
        _ => (None, None),
    }
}

/// The place where a contour crosses itself, as an error.
fn crossing(contour: &Composite, what: &'static str) -> Option<ContourError> {
    let SelfCrossing { pieces: [first, second], point: [x, y], .. } = contour.self_crossing()?;
    Some(ContourError::Crosses { what, first: first + 1, second: second + 1, x, y })
}

fn motion(table: &ObjectTable) -> Result<Motion, Fault> {
    let mut motion = Motion { mirror: table.mirror, ..Motion::IDENTITY };
    if let Some(position) = &table.position {
        motion.translation = position.get_ref().0;
        if let Some(value) = motion.translation.iter().find(|number| !number.is_finite()) {
            return Err(Fault::new(
                position.span(),
                format!("position has {value}, expected two finite numbers: [x, y] in m"),
            ));
        }
    }
    if let Some(angle) = &table.angle {
        let degrees = *angle.get_ref();
        if !degrees.is_finite() {
            return Err(Fault::new(angle.span(), format!("angle is {degrees}, expected a finite number of degrees")));
        }
        motion.rotation = degrees.to_radians();
    }
    if let Some(scale) = &table.scale {
        motion.scale = *scale.get_ref();
        if !(motion.scale.is_finite() && motion.scale > 0.0) {
            let message =
                format!("scale is {}, expected a positive, finite number; mirror = true turns it over", motion.scale);
            return Err(Fault::new(scale.span(), message));
        }
    }
    Ok(motion)
}

/// The contour, if it runs as it is said to.
fn check_orientation(contour: Composite, hollow: Option<&Spanned<bool>>, at: Range<usize>) -> Result<Composite, Fault> {
    let said = hollow.is_some_and(|hollow| *hollow.get_ref());
    let span = hollow.map_or(at, Spanned::span);
    match (said, contour.is_closed(), contour.is_cavity()) {
        (false, _, true) => Err(Fault::new(
            span,
            "the contour runs clockwise, which puts the solid outside; give its pieces in the other order or reversed = true, or hollow = true for a cavity",
        )),
        (true, true, false) => Err(Fault::new(
            span,
            "hollow, but the contour runs counterclockwise, which puts the solid inside; leave hollow out, or reverse the contour with reversed = true",
        )),
        (true, false, _) => Err(Fault::new(
            span,
            "hollow, but the contour is not closed; leave hollow out, or let its last piece end where the first one starts",
        )),
        _ => Ok(contour),
    }
}
