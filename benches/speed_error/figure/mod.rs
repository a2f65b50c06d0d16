//! Figures: time against error, a panel for each task or problem, one line a method.

mod axis;
mod canvas;
mod look;
mod panel;

use crate::row::Row;
use canvas::{BODY, INK, Sheet, Side, TITLE, width};
use look::Look;
use panel::{SIZE, ZERO, coordinates};

/// A figure of one or more panels.
pub struct Figure<'a> {
    /// Of the file, without its ending.
    pub name: &'static str,
    pub title: &'static str,
    /// What is on the time axis.
    pub unit: &'static str,
    pub panels: Vec<Panel<'a>>,
}

/// Points to be seen together.
pub struct Panel<'a> {
    pub title: String,
    pub rows: Vec<&'a Row>,
}

/// Height of the title and of a row of the legend; pixels of a sample, and between entries.
const HEAD: f64 = 64.0;
const ROW: f64 = 38.0;
const SAMPLE: f64 = 44.0;
const APART: f64 = 24.0;
const MARGIN: f64 = 24.0;

impl Figure<'_> {
    /// The methods that have points, in the order in which they come.
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for row in self.panels.iter().flat_map(|panel| &panel.rows).filter(|row| coordinates(row).is_some()) {
            if !methods.contains(&row.method.as_str()) {
                methods.push(&row.method);
            }
        }
        methods
    }

    /// Draws it; none where there are no points.
    pub fn draw(&self) -> Option<String> {
        let all: Vec<&Row> = self.panels.iter().flat_map(|panel| panel.rows.iter().copied()).collect();
        let drawn = || all.iter().filter(|row| coordinates(row).is_some());
        let methods = self.methods();
        if methods.is_empty() {
            return None;
        }
        let columns = self.panels.len().min(2);
        let lines = self.panels.len().div_ceil(columns);
        let size = (SIZE.0 * columns as f64, SIZE.1 * lines as f64);
        let entry = |method: &str| SAMPLE + width(method, BODY) + APART;
        let (mut places, mut x, mut row) = (Vec::new(), MARGIN, 0.0);
        for method in &methods {
            if x > MARGIN && x + entry(method) > size.0 {
                (x, row) = (MARGIN, row + 1.0);
            }
            places.push((x, HEAD + ROW * row + 0.5 * ROW));
            x += entry(method);
        }
        let zero = drawn().any(|row| row.error == Some(0.0));
        let zero = zero.then(|| format!("an error of 0 is drawn at {ZERO:e}"));
        let last = HEAD + ROW * (row + 1.0);
        let above = last + if zero.is_some() { ROW } else { 0.0 };
        Some(Sheet::svg((size.0, size.1 + above), |sheet| {
            sheet.write(self.title, (MARGIN, 36.0), Side::Left, TITLE, INK);
            for (index, (method, (x, y))) in methods.iter().zip(places).enumerate() {
                let look = Look(index);
                look.line(sheet, &[(x, y), (x + SAMPLE - 10.0, y)]);
                look.mark(sheet, (x + 0.5 * SAMPLE - 5.0, y));
                sheet.write(method, (x + SAMPLE, y), Side::Left, BODY, INK);
            }
            zero.iter().for_each(|zero| sheet.write(zero, (MARGIN, last + 0.5 * ROW), Side::Left, BODY, INK));
            for (index, panel) in self.panels.iter().enumerate() {
                let of = |method: &str| panel.rows.iter().copied().filter(|row| row.method == method).collect();
                let lines = methods.iter().enumerate().map(|(index, method)| (Look(index), of(method))).collect();
                let corner = (SIZE.0 * (index % columns) as f64, above + SIZE.1 * (index / columns) as f64);
                sheet.part(corner, |sheet| panel::draw(sheet, &panel.title, self.unit, &lines, &all));
            }
        }))
    }
}
