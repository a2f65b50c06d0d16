//! The objects of a scene, built shape by shape.

use crate::outline::{Line, outline};
use crate::page::Failure;
use std::f64::consts::TAU;
use std::mem;
use vibrissa::{CircularArc, Composite, Contour, Parabola, contour};

/// Objects that are complete, and the shapes and corners of the next one.
#[derive(Default)]
pub struct Objects {
    complete: Vec<Composite>,
    shapes: Vec<Box<dyn Contour>>,
    corners: Vec<contour::Point>,
}

impl Objects {
    fn add(&mut self, shape: impl Contour + 'static) -> Result<String, Failure> {
        self.shapes.push(Box::new(shape));
        Ok(String::new())
    }

    pub fn parabola(&mut self, vertex: contour::Point, coefficient: f64) -> Result<String, Failure> {
        self.add(Parabola::new(vertex, coefficient)?)
    }

    pub fn disc(&mut self, center: contour::Point, radius: f64) -> Result<String, Failure> {
        self.add(CircularArc::new(center, radius, 0.0, TAU)?)
    }

    pub fn corner(&mut self, at: contour::Point) -> Result<String, Failure> {
        self.corners.push(at);
        Ok(String::new())
    }

    /// A polygon is an object by itself.
    pub fn polygon(&mut self) -> Result<String, Failure> {
        self.complete.push(Composite::polygon(&mem::take(&mut self.corners))?);
        Ok(String::new())
    }

    pub fn join(&mut self) -> Result<String, Failure> {
        self.complete.push(Composite::joined(mem::take(&mut self.shapes))?);
        Ok(String::new())
    }

    /// The objects for a rod, which looks at them as long as the instance lives: a copy that is never freed, some kB a scene.
    pub fn lasting(&self) -> &'static [Composite] {
        Box::leak(self.complete.clone().into_boxed_slice())
    }

    pub fn outlines(&self) -> Vec<Line> {
        self.complete.iter().map(outline).collect()
    }
}
