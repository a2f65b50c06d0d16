//! Figures: time against error, a panel for each task or problem, one line a method.

mod axis;
mod canvas;
mod panel;

use crate::row::Row;
use canvas::{BODY, INK, Look, TITLE, svg, width, write};
use panel::{SIZE, ZERO, coordinates};
use plotters::style::text_anchor::HPos;

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
const HEAD: u32 = 64;
const ROW: u32 = 38;
const SAMPLE: i32 = 40;
const APART: i32 = 30;
const MARGIN: i32 = 24;

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
        let columns = (self.panels.len() as u32).min(2);
        let size = (SIZE.0 * columns, SIZE.1 * (self.panels.len() as u32).div_ceil(columns));
        let entry = |method: &str| SAMPLE + width(method, BODY) + APART;
        let (mut places, mut x, mut row) = (Vec::new(), MARGIN, 0);
        for method in &methods {
            if x > MARGIN && x + entry(method) > size.0 as i32 {
                (x, row) = (MARGIN, row + 1);
            }
            places.push((x, row));
            x += entry(method);
        }
        let zero = drawn().any(|row| row.error == Some(0.0));
        let zero = zero.then(|| format!("an error of 0 is drawn at {ZERO:e}"));
        let above = HEAD + ROW * (row + 1 + u32::from(zero.is_some()));
        Some(svg((size.0, size.1 + above), |root| {
            let (head, body) = root.split_vertically(above);
            write(&head, self.title, (MARGIN, 36), HPos::Left, TITLE, INK);
            let height = |row: u32| (HEAD + ROW * row + ROW / 2) as i32;
            for (index, (method, (x, row))) in methods.iter().zip(places).enumerate() {
                let (look, y) = (Look(index), height(row));
                look.line(&head, vec![(x, y), (x + SAMPLE - 10, y)]);
                look.mark(&head, (x + SAMPLE / 2 - 5, y));
                write(&head, method, (x + SAMPLE, y), HPos::Left, BODY, INK);
            }
            zero.iter().for_each(|zero| write(&head, zero, (MARGIN, height(row + 1)), HPos::Left, BODY, INK));
            let areas = body.split_evenly((size.1.div_ceil(SIZE.1) as usize, columns as usize));
            for (panel, area) in self.panels.iter().zip(&areas) {
                let of = |method: &str| panel.rows.iter().copied().filter(|row| row.method == method).collect();
                let lines = methods.iter().enumerate().map(|(index, method)| (Look(index), of(method))).collect();
                panel::draw(area, &panel.title, self.unit, &lines, &all);
            }
        }))
    }
}
