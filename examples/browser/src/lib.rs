//! A rod for a web page: a script moves its clamp from pose to pose and draws what comes back. The module imports nothing.
//!
//! ```sh
//! rustup target add wasm32-unknown-unknown
//! cargo build --release   # target/wasm32-unknown-unknown/release/browser.wasm
//! node --test             # rod.test.mjs shows how a script calls it
//! ```
//!
//! [`place`] and [`to`] return the number of contacts, or [`STOPPED`]. After that, [`reactions`] points to `f0x, f0y, m0z` (N, N,
//! N m), [`contacts`] to `s, x, y, force` of each contact (m, m, m, N), [`shape`] to `x, y` (m) of [`POINTS`] points of the rod,
//! all as `f64`, and [`message`] to the reason of a stop, UTF-8 of [`message_length`] bytes. The pointers hold until the next call
//! of [`place`] or [`to`].

use std::cell::RefCell;

use vibrissa::{Composite, Follower, Parabola, Pose, Rod};

/// Points of a shape, clamp and tip included.
pub const POINTS: usize = 101;
/// Returned where the rod cannot be placed at a pose, or brought there; it then stays where it was.
pub const STOPPED: i32 = -1;

type Failure = Box<dyn std::error::Error>;

/// The scene, and what the script may read of it.
#[derive(Default)]
struct Page {
    object: Option<&'static Composite>,
    rod: Option<Follower<'static>>,
    reactions: [f64; 3],
    contacts: Vec<f64>,
    shape: Vec<f64>,
    message: String,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::new(Page::default());
}

/// Steel wire, 100 mm long and 0.5 mm thick.
fn wire() -> Result<Rod, Failure> {
    Ok(Rod::from_diameter(0.1, 0.5e-3, 206e9)?)
}

/// The solid above y = 50/m x^2. It lives as long as the page.
fn object() -> Result<&'static Composite, Failure> {
    Ok(Box::leak(Box::new(Composite::single(Parabola::new([0.0, 0.0], 50.0)?)?)))
}

impl Page {
    fn place(&mut self, pose: Pose) -> Result<(), Failure> {
        let object = match self.object {
            Some(object) => object,
            None => self.object.insert(object()?),
        };
        self.rod = Some(Follower::new(&wire()?, object, pose)?);
        Ok(())
    }

    fn to(&mut self, pose: Pose) -> Result<(), Failure> {
        self.rod.as_mut().ok_or("no rod is placed yet, expected a call of place first")?.to(pose)?;
        Ok(())
    }

    fn show(&mut self) -> Result<i32, Failure> {
        let state = self.rod.as_ref().ok_or("no rod is placed yet")?.state();
        self.reactions = [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z];
        self.contacts = state.contacts.iter().flat_map(|at| [at.s, at.x, at.y, at.force]).collect();
        self.shape = state.elastica(&wire()?)?.sample(POINTS).flat_map(|at| [at.x, at.y]).collect();
        Ok(state.contacts.len() as i32)
    }
}

/// Makes a move and shows its result, or says why there is none.
fn moved(make: impl FnOnce(&mut Page) -> Result<(), Failure>) -> i32 {
    PAGE.with_borrow_mut(|page| match make(page).and_then(|()| page.show()) {
        Ok(contacts) => contacts,
        Err(failure) => {
            page.message = failure.to_string();
            STOPPED
        }
    })
}

/// A new rod, clamped at (x, y) m with the slope angle phi, rad.
#[unsafe(no_mangle)]
pub extern "C" fn place(x: f64, y: f64, phi: f64) -> i32 {
    moved(|page| page.place(Pose { x, y, phi }))
}

/// Brings the clamp to (x, y) m and phi rad, along a straight line and through all transitions on it.
#[unsafe(no_mangle)]
pub extern "C" fn to(x: f64, y: f64, phi: f64) -> i32 {
    moved(|page| page.to(Pose { x, y, phi }))
}

#[unsafe(no_mangle)]
pub extern "C" fn reactions() -> *const f64 {
    PAGE.with_borrow(|page| page.reactions.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn contacts() -> *const f64 {
    PAGE.with_borrow(|page| page.contacts.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn shape() -> *const f64 {
    PAGE.with_borrow(|page| page.shape.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn message() -> *const u8 {
    PAGE.with_borrow(|page| page.message.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn message_length() -> usize {
    PAGE.with_borrow(|page| page.message.len())
}
