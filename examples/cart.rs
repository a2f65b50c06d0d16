//! A simulator with a whisker in it: a cart rolls against a post with the whisker ahead, which bends, and throws the cart
//! back, or slips off and lets it pass. docs/tutorials/simulator.md explains it. `cargo run --release --example cart 0.6`
//! starts at 0.6 m/s and draws cart.svg.
#![allow(missing_docs, clippy::print_stdout, reason = "an example is there to be read and run")]

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;

use vibrissa::contact::Item;
use vibrissa::{CircularArc, Composite, Event, Follower, Pose, Rod, State};

/// Mass of the cart, kg.
pub const MASS: f64 = 0.1;
/// Time step, s.
pub const STEP: f64 = 1e-3;
/// The post, m.
const CENTER: [f64; 2] = [0.0, 0.045];
const RADIUS: f64 = 0.01;

/// One time step: time (s) and speed of the cart (m/s) at its end; the whisker, whose clamp is on the cart, and what
/// happened to it.
pub struct Moment {
    pub time: f64,
    pub speed: f64,
    pub whisker: State,
    pub events: Vec<Event>,
}

/// The cart from x = 50 mm with this speed along x (m/s), until it is past the post or back.
pub fn roll(rod: &Rod, post: &Composite, mut speed: f64) -> Result<Vec<Moment>, Box<dyn Error>> {
    let clamp = |x| Pose { x, y: 0.0, phi: FRAC_PI_2 };
    let mut whisker = Follower::new(rod, post, clamp(0.05))?;
    let (mut x, mut time) = (0.05, 0.0);
    let mut moments = Vec::new();
    while (-0.1..0.06).contains(&x) && time < 5.0 {
        // the clamp pushes the rod with `reactions`, hence the rod the cart with the opposite
        speed -= whisker.state().reactions.f0x / MASS * STEP;
        x += speed * STEP;
        time += STEP;
        let mut events = Vec::new();
        for item in whisker.to(clamp(x))? {
            if let Item::Event(event) = item {
                events.push(event);
            }
        }
        moments.push(Moment { time, speed, events, whisker: whisker.state().clone() });
    }
    Ok(moments)
}

/// Cart and whisker every 20 ms, blue in contact, as a picture with a scale and the direction in which the cart starts.
fn draw(rod: &Rod, moments: &[Moment]) -> Result<String, Box<dyn Error>> {
    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-110 -105 170 125' width='680' fill='none'\n\
         stroke-width='0.4' font-family='sans-serif' font-size='5' style='background:white'>\n",
    );
    for moment in moments.iter().step_by(20) {
        let color = if moment.whisker.contacts.is_empty() { "#999" } else { "#0072b2" };
        write!(svg, "<polyline stroke='{color}' points='")?;
        for point in moment.whisker.elastica(rod)?.sample(30) {
            write!(svg, "{:.2},{:.2} ", 1e3 * point.x, -1e3 * point.y)?;
        }
        writeln!(
            svg,
            "'/>\n<rect x='{:.2}' y='0' width='6' height='4' stroke='black'/>",
            1e3 * moment.whisker.pose.x - 3.0
        )?;
    }
    let [x, y, radius] = [1e3 * CENTER[0], -1e3 * CENTER[1], 1e3 * RADIUS];
    writeln!(svg, "<circle cx='{x}' cy='{y}' r='{radius}' fill='#ddd' stroke='black'/>")?;
    svg.push_str(
        "<path d='M 30 12 H 50 M 30 11 V 13 M 50 11 V 13 M 10 12 H -20 M -17 10.5 L -20 12 L -17 13.5' stroke='black'/>\n\
         <g fill='black' text-anchor='middle'><text x='40' y='18'>20 mm</text><text x='-5' y='18'>cart</text></g>\n\
         </svg>\n",
    );
    Ok(svg)
}

/// The whisker, a steel wire, and the post.
pub fn scene() -> Result<(Rod, Composite), Box<dyn Error>> {
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9)?; // length m, diameter m, Young's modulus Pa
    Ok((rod, Composite::single(CircularArc::new(CENTER, RADIUS, 0.0, TAU)?)?))
}

/// What happened to the whisker, a line each, and where the cart ends.
pub fn report(moments: &[Moment]) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    for moment in moments {
        for event in &moment.events {
            let (x, from, to) = (1e3 * event.pose().x, event.from(), event.to());
            writeln!(text, "{:5.3} s  {x:7.2} mm  {:14} {from} -> {to}", moment.time, event.kind)?;
        }
    }
    if let Some(last) = moments.last() {
        writeln!(text, "{:5.3} s  {:7.2} mm  {:.3} m/s", last.time, 1e3 * last.whisker.pose.x, last.speed)?;
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    let speed: f64 = std::env::args().nth(1).map_or(Ok(0.6), |word| word.parse())?;
    let (rod, post) = scene()?;
    let moments = roll(&rod, &post, -speed)?;
    print!("{}", report(&moments)?);
    std::fs::write("cart.svg", draw(&rod, &moments)?)?;
    Ok(())
}
