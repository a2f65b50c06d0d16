//! Composites: where the pieces cross, what stands between them, and what each stretch is alone.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use rod_contours::{Composite, Contour, Frame, Motion, Parabola, Range, StretchKind, contract};

#[test]
fn the_objects_of_the_paper() {
    for (left, right, at) in [
        ([0.0, 0.0], [0.3, 0.0], 0.15),
        ([0.0, 0.0], [0.3, 0.1], 0.15 + 0.1 / 3.0),
        ([0.0, 0.1], [0.3, 0.0], 0.15 - 0.1 / 3.0),
    ] {
        let pieces: Vec<Box<dyn Contour>> =
            vec![Box::new(Parabola::new(left, 5.0).unwrap()), Box::new(Parabola::new(right, 5.0).unwrap())];
        let object = Composite::joined(pieces).unwrap();
        let stretches: Vec<_> = object.stretches().collect();
        assert_eq!(stretches.len(), 3);
        assert_eq!(stretches[1].kind, StretchKind::Notch { before: 0 });
        let crossing = object.frame(stretches[1].range.from);
        assert!((crossing.x - at).abs() < 1e-15, "{}", crossing.x);
        let turn = (10.0 * at).atan() + (10.0 * (0.3 - at)).atan();
        assert!((stretches[1].range.length() - turn).abs() < 1e-14);
        // Above the notch lies the solid, with the notch the nearest point; below, a parabola is nearer.
        let inside = object.closest(at, crossing.y + 0.01);
        assert!((inside.gap + 0.01).abs() < 1e-15 && inside.interior);
        assert_eq!(object.stretch_at(inside.t), 1);
        let below = object.closest(at, crossing.y - 0.05);
        assert!(below.gap > 0.0 && below.gap < 0.05 && object.stretch_at(below.t) != 1);
    }
}

#[test]
fn a_parabola_cut_in_two_has_a_smooth_joint() {
    let whole = Parabola::new([0.3, 0.1], 2.0).unwrap();
    let pieces: Vec<Box<dyn Contour>> =
        vec![Box::new(whole.between(-1.0, 0.41).unwrap()), Box::new(whole.between(0.41, 2.0).unwrap())];
    let cut = Composite::new(pieces).unwrap();
    assert_eq!(cut.stretches().len(), 2);
    let uncut = whole.between(-1.0, 2.0).unwrap();
    for k in 0..200 {
        let (x, y) = (-1.5 + 0.02 * f64::from(k), 0.7 * (f64::from(k) * 0.37).sin());
        let (one, two) = (cut.closest(x, y), uncut.closest(x, y));
        assert!((one.gap - two.gap).abs() < 1e-15 && one.interior == two.interior);
    }
    // Seen along the normal of the cut, the cut is no end.
    let frame = uncut.frame(0.11);
    let (nx, ny) = frame.normal();
    assert!(cut.closest(frame.x - 0.1 * nx, frame.y - 0.1 * ny).interior);
}

#[test]
fn stretches_continue_smoothly_beyond_themselves() {
    let pieces: Vec<Box<dyn Contour>> = vec![
        Box::new(Parabola::new([1.0, 0.0], 1.0).unwrap().between(-1.0, 0.0).unwrap()),
        Box::new(Parabola::new([-1.0, 0.0], 1.0).unwrap().between(0.0, 1.0).unwrap()),
    ];
    let wedge = Composite::new(pieces).unwrap();
    let corner = wedge.stretch(1).range;
    let beyond = wedge.frame_on(0, corner.from + 0.1);
    assert!((beyond.x - 0.1).abs() < 1e-15 && (beyond.y - 0.81).abs() < 1e-15);
    let turned = wedge.frame_on(1, corner.to + 0.1);
    assert!((turned.alpha - (2.0_f64.atan() + 0.1)).abs() < 1e-15);
    assert_eq!((turned.x, turned.y, turned.speed, turned.turning), (0.0, 1.0, 0.0, 1.0));
    // The nearest point of one stretch alone is not that of the whole.
    let left = wedge.closest_on(0, 0.5, 0.0);
    assert!(!left.interior && left.t == corner.from);
    assert_eq!(wedge.closest_on(1, 0.0, 0.0).gap, 1.0);
    assert_eq!(wedge.stretch_at(corner.from), 1);
    assert_eq!(wedge.stretch_at(f64::INFINITY), 2);
}

/// A quarter of the unit circle that counts its angle from 0 and its alpha in whichever turn it likes.
#[derive(Debug)]
struct Quarter {
    from: f64,
    turns: f64,
}

impl Contour for Quarter {
    fn frame(&self, t: f64) -> Frame {
        let (sin, cos) = (self.from + FRAC_PI_2 * t).sin_cos();
        Frame {
            x: cos,
            y: sin,
            alpha: self.from + FRAC_PI_2 * (t + 1.0) + TAU * self.turns,
            speed: FRAC_PI_2,
            turning: FRAC_PI_2,
        }
    }
}

#[test]
fn a_disc_of_four_quarters_turns_once() {
    let quarter = |from: f64, turns: f64| -> Box<dyn Contour> { Box::new(Quarter { from, turns }) };
    let disc =
        Composite::new(vec![quarter(0.0, 0.0), quarter(FRAC_PI_2, -3.0), quarter(PI, 1.0), quarter(1.5 * PI, 0.0)])
            .unwrap();
    assert_eq!(disc.stretches().len(), 4);
    assert_eq!(disc.range(), Range { from: 0.0, to: 4.0 });
    let turned = disc.frame(4.0).alpha - disc.frame(0.0).alpha;
    assert!((turned - TAU).abs() < 1e-12);
    contract::check(&disc, &[0.0, 0.1, 0.25, 0.5, 0.76, 0.99]).unwrap();
}

#[test]
fn a_distant_crowd_does_not_change_the_closest_point() {
    // A saw of 2000 teeth: the tree must find what looking at every stretch finds.
    let pieces = (0..2000)
        .map(|k| -> Box<dyn Contour> {
            let x = f64::from(k);
            let up = Parabola::new([x, 0.0], 1.0).unwrap();
            Box::new(up.between(x - 0.5, x + 0.5).unwrap())
        })
        .collect();
    let saw = Composite::new(pieces).unwrap();
    assert_eq!(saw.stretches().len(), 3999);
    for k in 0..100 {
        let (x, y) = (19.97 * f64::from(k), (f64::from(k) * 0.61).sin());
        let best = (0..saw.stretches().len())
            .map(|stretch| saw.closest_on(stretch, x, y).gap.abs())
            .fold(f64::INFINITY, f64::min);
        assert_eq!(saw.gap(x, y).abs(), best);
    }
}

#[test]
fn a_part_of_a_composite_ends_where_it_is_cut() {
    let pieces: Vec<Box<dyn Contour>> = vec![
        Box::new(Parabola::new([1.0, 0.0], 1.0).unwrap().between(-1.0, 0.0).unwrap()),
        Box::new(Parabola::new([-1.0, 0.0], 1.0).unwrap().between(0.0, 1.0).unwrap()),
    ];
    let wedge = Composite::new(pieces).unwrap();
    let corner = wedge.stretch(1).range;
    let middle = 0.5 * (corner.from + corner.to);
    let left = Range { from: wedge.range().from, to: middle };
    // Straight below, the cut is the very tangent; to the right the part has no tangent any more; to the left it has.
    assert!(!wedge.closest_in(left, 0.4, 0.5).interior);
    assert_eq!(wedge.closest_in(left, 0.4, 0.5).t, middle);
    assert!(wedge.closest_in(left, -0.1, 0.5).interior);
    assert!(wedge.closest_in(left, -1.0, 2.0).interior);
    let right = Range { from: corner.to + 0.2, to: wedge.range().to };
    let end = wedge.closest_in(right, -0.5, 1.0);
    assert!(!end.interior && end.t == right.from);
    let bounds = wedge.bounds_in(left);
    assert!(bounds.contains(0.0, 1.0) && bounds.max[0] == 0.0);
}

#[test]
fn a_clone_is_the_same_contour() {
    let bump = |x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as Box<dyn Contour>;
    let contour = Composite::joined(vec![bump(0.0), bump(0.3)]).unwrap();
    let motion = Motion { rotation: 0.4, mirror: true, ..Motion::default() };
    let moved = contour.clone().moved(motion).unwrap();
    let alone = contour.moved(motion).unwrap();
    for k in -20..20 {
        let (x, y) = (0.03 * f64::from(k), -0.1);
        assert_eq!(moved.closest(x, y), alone.closest(x, y));
    }
}
