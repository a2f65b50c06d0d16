//! The sweep of a bent rod: its equilibria followed along the scan, with changes of the contacts, snaps and the snap-off.
//!
//! After a snap the contacts of the ideal rod near this pose are tried.

use super::bent::{Bent, Fault, Shape, Touch};
use super::truth::{Site, TrueState, Truth};
use super::world::World;
use vibrissa::contact::{ContactKind, Item};
use vibrissa::contour::StretchKind;
use vibrissa::rod::Reactions;
use vibrissa::{ClampPath, Composite, Label, Pose, State, Sweep};

/// Largest change of the curvature at the clamp between two samples without a snap. Just before a fold the change is about
/// the square root of the step.
const SNAP: f64 = 0.1;
/// Changes of the contacts at one pose.
const CHANGES: usize = 5;
/// Spacing of the states of the ideal rod, m, and how many of them on either side are tried.
const COARSE: f64 = 5e-4;
const TRIED: usize = 6;
/// Force that a new contact starts with.
const FIRST: f64 = 1e-6;

/// The sweep of a scene in a world. Poses without a solution have no state.
pub fn sweep(site: &Site, world: World, step: f64) -> Truth {
    let (rod, path) = (&site.scene.rod, site.path);
    let bent = Bent { objects: &site.scene.objects, length: rod.length(), world };
    let ideal = Ideal::new(site);
    let mut states = Vec::new();
    let (mut before, mut earlier): (Shape, Option<Shape>) = (bent.free(), None);
    for number in 0..=(path.length() / step).floor() as usize {
        let way = number as f64 * step;
        let pose = path.at(way);
        let scaled = Pose { x: pose.x / rod.length(), y: pose.y / rod.length(), phi: pose.phi };
        let guess = earlier.as_ref().map_or_else(|| before.clone(), |earlier| before.beyond(earlier));
        let close = |shape: &Shape| (shape.kappa - before.kappa).abs() < SNAP;
        let found = settle(&bent, &scaled, &guess, CHANGES).filter(close);
        let found = found.or_else(|| settle(&bent, &scaled, &before, CHANGES).filter(close));
        let landed = || {
            let tried = ideal.near(way).chain([bent.free()]);
            tried.filter_map(|guess| settle(&bent, &scaled, &guess, 1)).next()
        };
        let Some(shape) = found.or_else(landed) else { continue };
        let [f0x, f0y, m0z] = bent.reactions(&shape);
        let units = rod.units();
        let reactions = Reactions { f0x: f0x * units.force, f0y: f0y * units.force, m0z: m0z * units.moment };
        let label = Label::of(shape.touches.len(), shape.touches.last().is_some_and(|touch| touch.tip));
        states.push(TrueState { way, pose, reactions, label });
        earlier = Some(std::mem::replace(&mut before, shape)).filter(|earlier| earlier.has_contacts_of(&before));
    }
    Truth::new(states)
}

/// The equilibrium near a guess; its contacts may change so many times.
fn settle(bent: &Bent<'_>, pose: &Pose, guess: &Shape, changes: usize) -> Option<Shape> {
    let shape = bent.solve(pose, guess)?;
    let Some(fault) = bent.fault(pose, &shape) else { return Some(shape) };
    let changes = changes.checked_sub(1)?;
    changed(bent.objects, &shape, fault).iter().find_map(|next| settle(bent, pose, next, changes))
}

/// Contacts that may cure a fault.
fn changed(objects: &[Composite], shape: &Shape, fault: Fault) -> Vec<Shape> {
    let with = |change: &dyn Fn(&mut Vec<Touch>)| {
        let mut next = shape.clone();
        change(&mut next.touches);
        next
    };
    let last = shape.touches.len().saturating_sub(1);
    match fault {
        Fault::Pulls(touch) => vec![with(&|touches| _ = touches.remove(touch))],
        Fault::BeyondTip => vec![with(&|touches| (touches[last].s, touches[last].tip) = (1.0, true))],
        Fault::Overturned => vec![with(&|touches| touches[last].tip = false)],
        Fault::OffStretch { touch, after } => {
            let Touch { object, stretch, .. } = shape.touches[touch];
            let contour = &objects[object];
            let moved = |by: usize, tip: bool| {
                let stretch = (0..by).try_fold(stretch, |stretch, _| contour.neighbour(stretch, after))?;
                let range = contour.stretch(stretch).range;
                let t = if after { range.from } else { range.to };
                Some(with(&|touches| {
                    let touch = &mut touches[touch];
                    (touch.stretch, touch.t, touch.tip) = (stretch, t, tip);
                    touch.s = if tip { 1.0 } else { touch.s };
                }))
            };
            // the next stretch; a straight one is passed over: the rod lies on it
            let tip = shape.touches[touch].tip;
            [moved(1, tip), moved(1, true), moved(2, tip)].into_iter().flatten().collect()
        }
        Fault::Through { object, t, s } => {
            let contact = |tip: bool| {
                with(&|touches| {
                    let stretch = objects[object].stretch_at(t);
                    let s = if tip { 1.0 } else { s };
                    let place = touches.partition_point(|touch| touch.s < s);
                    touches.insert(place, Touch { object, stretch, t, s, force: FIRST, tip });
                })
            };
            if s < 1.0 { vec![contact(false), contact(true)] } else { vec![contact(true), contact(false)] }
        }
    }
}

impl Shape {
    fn has_contacts_of(&self, other: &Self) -> bool {
        let same = |(a, b): (&Touch, &Touch)| (a.object, a.stretch, a.tip) == (b.object, b.stretch, b.tip);
        self.touches.len() == other.touches.len() && self.touches.iter().zip(&other.touches).all(same)
    }

    /// As far beyond this shape as this is beyond an earlier one.
    fn beyond(&self, earlier: &Self) -> Self {
        let mut next = self.clone();
        next.kappa += self.kappa - earlier.kappa;
        for (touch, earlier) in next.touches.iter_mut().zip(&earlier.touches) {
            touch.t += touch.t - earlier.t;
            touch.s += touch.s - earlier.s;
            touch.force += touch.force - earlier.force;
        }
        next
    }
}

/// Contacts of the ideal rod along the scan.
struct Ideal {
    shapes: Vec<Shape>,
}

impl Ideal {
    fn new(site: &Site) -> Self {
        let path = ClampPath::new(site.path.at(0.0), site.path.at(site.path.length())).unwrap();
        let items = Sweep::new(&site.scene.rod, &site.scene.objects, path, COARSE).unwrap();
        let states = items.filter_map(|item| match item.unwrap() {
            Item::State(state) => Some(state),
            Item::Event(_) => None,
        });
        Self { shapes: states.map(|state| shape(site, &state)).collect() }
    }

    fn near(&self, way: f64) -> impl Iterator<Item = Shape> {
        let here = (way / COARSE) as usize;
        let tried = (0..TRIED).flat_map(move |k| [Some(here + k), here.checked_sub(k)]).flatten();
        tried.filter_map(|k| self.shapes.get(k)).filter(|shape| !shape.touches.is_empty()).cloned()
    }
}

fn shape(site: &Site, state: &State) -> Shape {
    let units = site.scene.rod.units();
    let touches = state.contacts.iter().map(|contact| {
        let contour = &site.scene.objects[contact.object];
        let kind = match contact.kind {
            ContactKind::Corner => StretchKind::Corner { before: contact.piece },
            ContactKind::Notch => StretchKind::Notch { before: contact.piece },
            _ => StretchKind::Piece(contact.piece),
        };
        let stretch = contour.stretches().position(|stretch| stretch.kind == kind).unwrap();
        let t = if matches!(kind, StretchKind::Piece(_)) {
            contour.closest_on(stretch, contact.x, contact.y).t
        } else {
            let range = contour.stretch(stretch).range;
            range.from + (contact.alpha - contour.frame_on(stretch, range.from).alpha).abs()
        };
        let tip = matches!(contact.kind, ContactKind::Tip | ContactKind::Notch);
        let (s, force) = (contact.s / site.scene.rod.length(), contact.force / units.force);
        Touch { object: contact.object, stretch, t, s, force, tip }
    });
    Shape { kappa: -state.reactions.m0z / units.moment, touches: touches.collect() }
}
