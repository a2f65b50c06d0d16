//! What a contour of very many pieces costs: memory, and looks at its shapes while a rod sweeps past a few of them.
//!
//! How long that takes is for `cargo bench --bench growth`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may, and its numbers are there to be read")]

#[path = "../benches/measure/waves.rs"]
mod waves;

use allocation_counter::measure;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use vibrissa::contact::Outcome;
use vibrissa::contour::{Bounds, Closest, Frame, Range};
use vibrissa::{Composite, Contour};
use waves::{FEW, Kind, difference, objects, pieces_met, shapes, sweep};

/// Pieces of a long contour, and of one that is just too long for all of them to be looked at each time.
const MANY: usize = 100_000;
const MORE: usize = 100;
/// Kinds of pieces that make up one contour.
const KINDS: [Kind; 3] = [Kind::Edges, Kind::Ripples, Kind::Cubics];

#[test]
fn a_piece_takes_200_bytes_at_most() {
    for kind in KINDS {
        let mut built = None;
        let kept = measure(|| built = Some(objects(kind, MANY)));
        let bytes = kept.bytes_current as f64 / MANY as f64;
        println!("{kind:?}: {bytes:.1} bytes a piece");
        assert!(bytes <= 200.0, "{kind:?}: {bytes}");
    }
}

/// A shape that counts how often it is asked something.
#[derive(Debug)]
struct Counted {
    shape: Box<dyn Contour>,
    looks: Arc<AtomicUsize>,
}

impl Counted {
    fn look(&self) -> &dyn Contour {
        self.looks.fetch_add(1, Ordering::Relaxed);
        &*self.shape
    }
}

impl Contour for Counted {
    fn frame(&self, t: f64) -> Frame {
        self.look().frame(t)
    }
    fn range(&self) -> Range {
        self.shape.range()
    }
    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        self.look().closest_in(range, x, y)
    }
    fn bounds_in(&self, range: Range) -> Bounds {
        self.look().bounds_in(range)
    }
    fn cuts(&self, range: Range) -> Vec<f64> {
        self.shape.cuts(range)
    }
}

/// The sweep past so many pieces, and how often their shapes were asked something on the way.
fn counted(kind: Kind, pieces: usize) -> (Outcome, usize) {
    let looks = Arc::new(AtomicUsize::new(0));
    let shapes = shapes(kind, pieces).into_iter();
    let shapes = shapes.map(|shape| Box::new(Counted { shape, looks: looks.clone() }) as Box<dyn Contour>);
    let contour = [Composite::new(shapes.collect()).unwrap()];
    looks.store(0, Ordering::Relaxed);
    let outcome = sweep(&contour);
    (outcome, looks.load(Ordering::Relaxed))
}

#[test]
fn a_sweep_past_many_pieces_looks_at_no_more_of_them() {
    for kind in KINDS {
        let (few, few_looks) = counted(kind, FEW);
        let (_, more_looks) = counted(kind, MORE);
        let (many, many_looks) = counted(kind, MANY);
        let met = pieces_met(kind, &few);
        println!(
            "{kind:?}: {met} met, {few_looks} looks at {FEW} pieces, {more_looks} at {MORE}, {many_looks} at {MANY}"
        );
        assert!(met > FEW / 2 && few.events.len() > 1);
        assert!(difference(&many, &few) < 1e-9, "{kind:?}: {}", difference(&many, &few));
        assert!(many_looks <= 2 * few_looks.min(more_looks), "{kind:?}: {few_looks} {more_looks} {many_looks}");
    }
}

#[test]
fn separate_objects_far_away_change_nothing() {
    let (few, many) = (sweep(&objects(Kind::Discs, FEW)), sweep(&objects(Kind::Discs, 300)));
    assert!(few.events.len() > 1 && difference(&many, &few) < 1e-9);
}
