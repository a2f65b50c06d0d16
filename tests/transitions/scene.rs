//! Random scenes with and without friction, and the same scene in another frame: turned, shifted, mirrored, scaled, its path cut in legs.

use crate::common::numbers::Numbers;
use std::f64::consts::{PI, TAU};
use vibrissa::contact::{Chain, Coefficients, Item, Stop};
use vibrissa::contour::SplineEnd;
use vibrissa::rod::{ElasticClamp, Mounted, NaturalCurvature, PhysicalRod, Pose, RodSection};
use vibrissa::{CircularArc, Composite, EllipticArc, Line, Rod, Spline, Sweep};

pub type Point = [f64; 2];

/// A piece of an object, angles in radians.
#[derive(Clone, Debug)]
pub enum Piece {
    Line(Point, Point),
    /// Centre, radius, angles.
    Arc(Point, f64, [f64; 2]),
    /// Centre, radii, rotation, angles.
    Ellipse(Point, Point, f64, [f64; 2]),
    Polygon(Vec<Point>),
    Spline(Vec<Point>),
}

/// A rod of length 1 with the stiffness 1 at its clamp.
#[derive(Clone, Debug)]
pub enum Material {
    Uniform,
    /// Natural curvature at the clamp and at the tip.
    Bent([f64; 2]),
    /// Diameter of the tip over that of the base, and natural curvatures.
    Cone(f64, [f64; 2]),
    /// Length of the first of two sections; stiffness of the second; natural curvatures.
    Sections(f64, f64, [f64; 2]),
}

impl Material {
    /// Bending stiffness and natural curvature at an arc length.
    pub fn at(&self, s: f64) -> (f64, f64) {
        let line = |[from, to]: [f64; 2]| from + (to - from) * s;
        match *self {
            Self::Uniform => (1.0, 0.0),
            Self::Bent(bend) => (1.0, line(bend)),
            Self::Cone(tip, bend) => ((1.0 - (1.0 - tip) * s).powi(4), line(bend)),
            Self::Sections(joint, _, [first, _]) if s < joint => (1.0, first),
            Self::Sections(_, stiffness, [_, second]) => (stiffness, second),
        }
    }

    /// Where stiffness or curvature jump.
    pub fn joint(&self) -> Option<f64> {
        if let Self::Sections(joint, ..) = self { Some(*joint) } else { None }
    }

    fn mirrored(&self) -> Self {
        let flip = |[from, to]: [f64; 2]| [-from, -to];
        match *self {
            Self::Uniform => Self::Uniform,
            Self::Bent(bend) => Self::Bent(flip(bend)),
            Self::Cone(tip, bend) => Self::Cone(tip, flip(bend)),
            Self::Sections(joint, stiffness, bend) => Self::Sections(joint, stiffness, flip(bend)),
        }
    }
}

/// A scene in lengths of the rod; `length` is that of the rod in the unit of the sweep.
#[derive(Clone, Debug)]
pub struct Scene {
    pub kind: String,
    pub length: f64,
    pub material: Material,
    /// Stiffness of the springs under the clamp.
    pub springs: Option<[[f64; 3]; 3]>,
    pub objects: Vec<Vec<Piece>>,
    /// At rest and slipping, object by object; none without friction.
    pub friction: Option<Vec<[f64; 2]>>,
    pub poses: Vec<Pose>,
    pub step: f64,
}

/// A mirror (x to -x), then a turn, a shift and a scale.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub mirror: bool,
    pub turn: f64,
    pub shift: Point,
    pub scale: f64,
}

impl Frame {
    pub const OWN: Self = Self { mirror: false, turn: 0.0, shift: [0.0, 0.0], scale: 1.0 };

    fn point(&self, [x, y]: Point) -> Point {
        let x = if self.mirror { -x } else { x };
        let (sin, cos) = self.turn.sin_cos();
        [self.shift[0] + x * cos - y * sin, self.shift[1] + x * sin + y * cos]
    }

    fn angle(&self, angle: f64) -> f64 {
        self.turn + if self.mirror { PI - angle } else { angle }
    }

    /// The angles of an arc, whose sense a mirror turns round.
    fn angles(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        if self.mirror { [self.angle(to), self.angle(from)] } else { [self.angle(from), self.angle(to)] }
    }

    fn points(&self, points: &[Point]) -> Vec<Point> {
        let mut points: Vec<_> = points.iter().map(|point| self.point(*point)).collect();
        if self.mirror {
            points.reverse();
        }
        points
    }

    fn piece(&self, piece: &Piece) -> Piece {
        match piece {
            Piece::Line(from, to) if self.mirror => Piece::Line(self.point(*to), self.point(*from)),
            Piece::Line(from, to) => Piece::Line(self.point(*from), self.point(*to)),
            Piece::Arc(centre, radius, angles) => Piece::Arc(self.point(*centre), *radius, self.angles(*angles)),
            Piece::Ellipse(centre, radii, rotation, [from, to]) => {
                // eccentric angles count from the first axis
                let (rotation, angles) = if self.mirror {
                    (self.turn - rotation, [PI - to, PI - from])
                } else {
                    (self.turn + rotation, [*from, *to])
                };
                Piece::Ellipse(self.point(*centre), *radii, rotation, angles)
            }
            Piece::Polygon(points) => Piece::Polygon(self.points(points)),
            Piece::Spline(points) => Piece::Spline(self.points(points)),
        }
    }

    pub fn pose(&self, Pose { x, y, phi }: Pose) -> Pose {
        let [x, y] = self.point([x, y]);
        Pose { x, y, phi: self.angle(phi) }
    }

    /// The pose in the scene's own frame of one in this frame and unit.
    pub fn back(&self, Pose { x, y, phi }: Pose, length: f64) -> Pose {
        let (dx, dy) = (x / length - self.shift[0], y / length - self.shift[1]);
        let (sin, cos) = self.turn.sin_cos();
        let (x, y) = (dx * cos + dy * sin, dy * cos - dx * sin);
        if self.mirror { Pose { x: -x, y, phi: PI - (phi - self.turn) } } else { Pose { x, y, phi: phi - self.turn } }
    }
}

impl Scene {
    /// The same scene in another frame.
    pub fn seen(&self, frame: &Frame) -> Self {
        let pieces = |object: &Vec<Piece>| {
            let mut pieces: Vec<_> = object.iter().map(|piece| frame.piece(piece)).collect();
            if frame.mirror {
                pieces.reverse();
            }
            pieces
        };
        let springs = self.springs.map(|k| {
            let (sin, cos) = frame.turn.sin_cos();
            let flip = if frame.mirror { -1.0 } else { 1.0 };
            // rows: the axes of the scene in the frame
            let r = [[flip * cos, -sin, 0.0], [flip * sin, cos, 0.0], [0.0, 0.0, flip]];
            std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..9).map(|n| r[i][n / 3] * k[n / 3][n % 3] * r[j][n % 3]).sum::<f64>())
            })
        });
        Self {
            length: self.length * frame.scale,
            material: if frame.mirror { self.material.mirrored() } else { self.material.clone() },
            springs,
            objects: self.objects.iter().map(pieces).collect(),
            poses: self.poses.iter().map(|pose| frame.pose(*pose)).collect(),
            ..self.clone()
        }
    }

    /// The same way of the clamp with each leg cut in two at this share.
    pub fn cut(&self, share: f64) -> Self {
        let mut poses = vec![self.poses[0]];
        for pair in self.poses.windows(2) {
            let between = |from: f64, to: f64| from + share * (to - from);
            let [a, b] = [pair[0], pair[1]];
            poses.push(Pose { x: between(a.x, b.x), y: between(a.y, b.y), phi: between(a.phi, b.phi) });
            poses.push(b);
        }
        Self { poses, ..self.clone() }
    }

    pub fn composites(&self) -> Vec<Composite> {
        let l = self.length;
        let at = |[x, y]: &Point| [x * l, y * l];
        let all = |points: &[Point]| points.iter().map(at).collect::<Vec<_>>();
        let composite = |pieces: &Vec<Piece>| {
            if let [Piece::Polygon(points)] = &pieces[..] {
                return Composite::polygon(&all(points)).unwrap();
            }
            let boxed = |piece: &Piece| -> Box<dyn vibrissa::Contour> {
                match piece {
                    Piece::Line(from, to) => Box::new(Line::new(at(from), at(to)).unwrap()),
                    Piece::Arc(centre, radius, [from, to]) => {
                        Box::new(CircularArc::new(at(centre), radius * l, *from, *to).unwrap())
                    }
                    Piece::Ellipse(centre, radii, rotation, [from, to]) => {
                        Box::new(EllipticArc::new(at(centre), at(radii), *rotation, *from, *to).unwrap())
                    }
                    Piece::Spline(points) => Box::new(Spline::through(&all(points), SplineEnd::Periodic).unwrap()),
                    Piece::Polygon(_) => panic!("a polygon is an object of its own"),
                }
            };
            Composite::new(pieces.iter().map(boxed).collect()).unwrap()
        };
        self.objects.iter().map(composite).collect()
    }

    /// All items of the sweep, with states at `share` of the scene's step.
    pub fn items(&self, share: f64) -> Vec<Result<Item, Stop>> {
        let l = self.length;
        let rod = Rod::new(l, l).unwrap();
        let bend = |[from, to]: [f64; 2]| NaturalCurvature::points(&[[0.0, from / l], [l, to / l]]).unwrap();
        match &self.material {
            Material::Uniform => self.with_clamp(rod, share),
            Material::Bent(curvature) => self.with_clamp(rod.with_natural_curvature(bend(*curvature)).unwrap(), share),
            Material::Cone(tip, curvature) => {
                let base = 0.01 * l;
                let cone = Rod::tapered(l, base, tip * base, 64.0 * l / (PI * base.powi(4))).unwrap();
                self.with_clamp(cone.with_natural_curvature(bend(*curvature)).unwrap(), share)
            }
            Material::Sections(joint, stiffness, [first, second]) => {
                let section = |length: f64, stiffness: f64, curvature: f64| RodSection {
                    length: length * l,
                    bending_stiffness: stiffness * l,
                    natural_curvature: curvature / l,
                };
                let sections = [section(*joint, 1.0, *first), section(1.0 - joint, *stiffness, *second)];
                self.with_clamp(Rod::sections(l, &sections).unwrap(), share)
            }
        }
    }

    fn with_clamp<R: PhysicalRod<Clamp = Pose>>(&self, rod: R, share: f64) -> Vec<Result<Item, Stop>> {
        let Some(k) = self.springs else { return self.swept(&rod, share) };
        // E I is the length: forces of E I / L^2 are 1 / length, moments 1
        let l = self.length;
        let unit = |i: usize, j: usize| match (i == 2, j == 2) {
            (false, false) => 1.0 / (l * l),
            (true, true) => 1.0,
            _ => 1.0 / l,
        };
        let k = std::array::from_fn(|i| std::array::from_fn(|j| k[i][j] * unit(i, j)));
        self.swept(&Mounted::new(rod, ElasticClamp::stiffness(k).unwrap()), share)
    }

    fn swept<R: PhysicalRod>(&self, rod: &R, share: f64) -> Vec<Result<Item, Stop>> {
        let l = self.length;
        let poses: Vec<_> = self.poses.iter().map(|p| Pose { x: p.x * l, y: p.y * l, phi: p.phi }).collect();
        let (objects, path) = (self.composites(), Chain::polyline(&poses).unwrap());
        let sweep = Sweep::new(rod, &objects, path, self.step * share * l).unwrap();
        let Some(friction) = &self.friction else { return sweep.collect() };
        let law = |object: usize, _piece: usize| {
            let [at_rest, slipping] = friction[object];
            Coefficients { at_rest, slipping }
        };
        sweep.with_friction(law).unwrap().collect()
    }
}

const KINDS: [&str; 7] = ["disc", "ellipse", "star", "polygon", "rounded rectangle", "lens", "spline"];

/// An object of one of the kinds, about the origin of a place, within a radius.
fn object(numbers: &mut Numbers, kind: &str, centre: Point, radius: f64) -> Vec<Piece> {
    let turn = numbers.within(0.0, TAU);
    let polar = |far: f64, angle: f64| [centre[0] + far * (turn + angle).cos(), centre[1] + far * (turn + angle).sin()];
    match kind {
        "disc" => vec![Piece::Arc(centre, radius, [turn, turn + TAU])],
        "ellipse" => {
            let aspect = numbers.within(0.25, 0.95);
            vec![Piece::Ellipse(centre, [radius, aspect * radius], turn, [0.3, 0.3 + TAU])]
        }
        "star" | "polygon" | "spline" => {
            let count = if kind == "star" { 5 + numbers.below(5) } else { 3 + numbers.below(5) };
            let count = if kind == "spline" { count + 2 } else { count };
            let least = match kind {
                "star" => 0.5,
                "polygon" => 1.0,
                _ => 0.6,
            };
            let points: Vec<_> = (0..count)
                .map(|k| {
                    let angle = (k as f64 + numbers.within(-0.3, 0.3)) * TAU / count as f64;
                    polar(radius * numbers.within(least, 1.0), angle)
                })
                .collect();
            vec![if kind == "spline" { Piece::Spline(points) } else { Piece::Polygon(points) }]
        }
        "rounded rectangle" => {
            let (half, other) = (0.8 * radius, 0.8 * radius * numbers.within(0.2, 0.7));
            let round = other * numbers.within(0.02, 0.9);
            let corners = [(half, other), (-half, other), (-half, -other), (half, -other)];
            let local = |x: f64, y: f64| polar(x.hypot(y), y.atan2(x));
            let mut pieces = Vec::new();
            for (k, (x, y)) in corners.into_iter().enumerate() {
                let (cx, cy) = (x - round * x.signum(), y - round * y.signum());
                let from = 0.25 * TAU * k as f64;
                let on = |angle: f64| local(cx + round * angle.cos(), cy + round * angle.sin());
                pieces.push(Piece::Arc(local(cx, cy), round, [turn + from, turn + from + 0.25 * TAU]));
                let (nx, ny) = corners[(k + 1) % 4];
                let next = (nx - round * nx.signum(), ny - round * ny.signum());
                let ahead = from + 0.25 * TAU;
                let to = local(next.0 + round * ahead.cos(), next.1 + round * ahead.sin());
                pieces.push(Piece::Line(on(ahead), to));
            }
            pieces
        }
        _ => {
            // two arcs between two corners
            let half = numbers.within(0.3, 1.2);
            let r = radius / half.sin();
            let off = r * half.cos();
            let arc = |side: f64| {
                let middle = turn + side * 0.5 * PI;
                let centre = [centre[0] - off * middle.cos(), centre[1] - off * middle.sin()];
                Piece::Arc(centre, r, [middle - half, middle + half])
            };
            vec![arc(1.0), arc(-1.0)]
        }
    }
}

/// The scene of a seed, for ever the same.
pub fn scene(seed: u64) -> Scene {
    let mut n = Numbers(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let bend = |n: &mut Numbers| [n.within(-1.8, 1.8), n.within(-1.8, 1.8)];
    let (name, material) = match n.below(4) {
        0 => ("uniform", Material::Uniform),
        1 => ("bent", Material::Bent(bend(&mut n))),
        2 => {
            let tip = 10.0_f64.powf(n.within(-1.5, -0.2));
            let curvature = if n.below(2) == 0 { [0.0; 2] } else { bend(&mut n) };
            ("cone", Material::Cone(tip, curvature))
        }
        _ => ("sections", Material::Sections(n.within(0.2, 0.8), 10.0_f64.powf(n.within(-1.0, 0.5)), bend(&mut n))),
    };
    let springs = (n.below(3) == 0).then(|| {
        let mut k = [[0.0; 3]; 3];
        for (i, row) in k.iter_mut().enumerate() {
            row[i] = 10.0_f64.powf(if i == 2 { n.within(0.3, 2.0) } else { n.within(1.0, 3.0) });
        }
        k
    });
    let (mut objects, mut kinds, mut rounds): (Vec<_>, Vec<_>, Vec<(Point, f64)>) = Default::default();
    for _ in 0..1 + n.below(3) {
        let kind = KINDS[n.below(7) as usize];
        let radius = 10.0_f64.powf(n.within(-1.3, -0.4));
        let centre = [n.within(-0.8, 0.8), n.within(0.3, 0.9)];
        // splines reach beyond their points
        let clear =
            |([x, y], other): &(Point, f64)| (x - centre[0]).hypot(y - centre[1]) > 1.15 * (radius + other) + 0.02;
        if !rounds.iter().all(clear) {
            continue;
        }
        rounds.push((centre, radius));
        kinds.push(kind);
        objects.push(object(&mut n, kind, centre, radius));
    }
    let rubs = n.below(2) == 0;
    let same = 10.0_f64.powf(n.within(-2.0, 0.2));
    let friction = rubs.then(|| {
        let one = |n: &mut Numbers| {
            let mu = if n.below(2) == 0 { same } else { 10.0_f64.powf(n.within(-2.0, 0.2)) };
            [if n.below(4) == 0 { mu * n.within(1.0, 2.0) } else { mu }, mu]
        };
        objects.iter().map(|_| one(&mut n)).collect()
    });
    let side = if n.below(2) == 0 { 1.0 } else { -1.0 };
    let lean = n.within(-0.5, 0.5);
    let at = |n: &mut Numbers, x: f64| Pose { x, y: n.within(-0.35, 0.0), phi: 0.5 * PI + lean + n.within(-0.3, 0.3) };
    let start = n.within(1.2, 1.9);
    let mut poses = vec![at(&mut n, side * start)];
    let far = n.within(-1.5, 0.3);
    poses.push(at(&mut n, side * far));
    for _ in 0..n.below(3) {
        let x = n.within(-1.5, 1.5);
        poses.push(at(&mut n, x));
    }
    let kind = format!(
        "{name}{}{} on {}",
        if springs.is_some() { ", springs" } else { "" },
        if rubs { ", friction" } else { "" },
        kinds.join(", ")
    );
    Scene { kind, length: 1.0, material, springs, objects, friction, poses, step: 0.03 }
}
