//! The rod of the page: a script builds a scene, moves the clamp from pose to pose and draws the answers. The module imports
//! nothing.
//!
//! 1. Shapes: [`parabola`], [`disc`], or [`corner`] for each corner and then [`polygon`]; [`join`] makes one object of the shapes
//!    since the last object.
//! 2. [`rod`] sets the rod and the friction of all objects.
//! 3. [`place`] puts the rod into the scene, [`move_to`] moves its clamp.
//!
//! Each function returns [`DONE`] or [`FAILED`]. After it, [`answer`] points to [`answer_length`] bytes of JSON in UTF-8: the state of
//! the rod after [`place`] and [`move_to`] (see `answer.rs`), the reason after a failure. The pointer holds until the next call.
//!
//! Another scene begins with [`clear`]. The instance keeps what a rod has looked at: the script takes another instance after some tens of
//! scenes.

mod answer;
mod objects;
mod outline;
mod page;
mod recovered;
mod wire;

use page::{Failure, Page};
use std::cell::RefCell;
use vibrissa::Pose;

/// The call did what it is for.
pub const DONE: i32 = 0;
/// The answer tells why nothing was done; the rod is where it was.
pub const FAILED: i32 = -1;

thread_local! {
    static PAGE: RefCell<Page> = RefCell::new(Page::default());
}

/// Does something to the page, and keeps the answer or the reason why there is none.
fn with_page(act: impl FnOnce(&mut Page) -> Result<String, Failure>) -> i32 {
    PAGE.with_borrow_mut(|page| {
        let (answer, status) = match act(page) {
            Ok(answer) => (answer, DONE),
            Err(failure) => (answer::failure(&failure), FAILED),
        };
        page.answer = answer;
        status
    })
}

/// Begins another scene, without objects and rod.
#[unsafe(no_mangle)]
pub extern "C" fn clear() -> i32 {
    with_page(|page| {
        *page = Page::default();
        Ok(String::new())
    })
}

/// The solid above y = `y` + `coefficient` (x - `x`)^2; m, m, 1/m.
#[unsafe(no_mangle)]
pub extern "C" fn parabola(x: f64, y: f64, coefficient: f64) -> i32 {
    with_page(|page| page.objects.parabola([x, y], coefficient))
}

/// The disc about (x, y); m.
#[unsafe(no_mangle)]
pub extern "C" fn disc(x: f64, y: f64, radius: f64) -> i32 {
    with_page(|page| page.objects.disc([x, y], radius))
}

/// The next corner of a polygon, counterclockwise; m.
#[unsafe(no_mangle)]
pub extern "C" fn corner(x: f64, y: f64) -> i32 {
    with_page(|page| page.objects.corner([x, y]))
}

/// The polygon of the corners since the last one.
#[unsafe(no_mangle)]
pub extern "C" fn polygon() -> i32 {
    with_page(|page| page.objects.polygon())
}

/// One object of the shapes since the last one, each left where it enters the next.
#[unsafe(no_mangle)]
pub extern "C" fn join() -> i32 {
    with_page(|page| page.objects.join())
}

/// A round wire: length and diameter at the clamp (m), Young's modulus (Pa), diameter of the tip over that of the clamp, curvature
/// at rest (1/m); and the coefficient of friction of all objects.
#[unsafe(no_mangle)]
pub extern "C" fn rod(length: f64, diameter: f64, modulus: f64, taper: f64, curvature: f64, friction: f64) -> i32 {
    with_page(|page| page.set_rod(&wire::spec(length, diameter, modulus, taper, curvature), friction))
}

/// The rod in equilibrium with its clamp at (x, y) m and the slope angle phi, rad.
#[unsafe(no_mangle)]
pub extern "C" fn place(x: f64, y: f64, phi: f64) -> i32 {
    with_page(|page| page.place(Pose { x, y, phi }))
}

/// Moves the clamp straight to (x, y) m and phi rad, through all transitions on the way.
#[unsafe(no_mangle)]
pub extern "C" fn move_to(x: f64, y: f64, phi: f64) -> i32 {
    with_page(|page| page.move_to(Pose { x, y, phi }))
}

/// The contours of the objects as lines to draw.
#[unsafe(no_mangle)]
pub extern "C" fn outlines() -> i32 {
    with_page(|page| Ok(answer::outlines(&page.objects.outlines())))
}

#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    PAGE.with_borrow(|page| page.answer.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    PAGE.with_borrow(|page| page.answer.len())
}
