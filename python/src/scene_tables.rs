//! Scene files as they are written: angles in degrees, tables of TOML.

use std::path::Path;
use toml::{Table, Value};
use vibrissa::contour::Motion;
use vibrissa::contour::description::Shape;

/// An angle in degrees whose conversion to radians, as the reader of scene files does it, gives `radians`: the shortest number if
/// there is one, else the nearest. A few angles have none, and come back with another last bit.
pub fn degrees(radians: f64) -> f64 {
    let exact = radians.to_degrees();
    let short = (exact * 1e9).round() / 1e9;
    let near =
        [short, exact, exact.next_up(), exact.next_down(), exact.next_up().next_up(), exact.next_down().next_down()];
    near.into_iter().find(|degrees| degrees.to_radians() == radians).unwrap_or(exact)
}

/// A shape of the library's description as a table.
pub fn piece(shape: &Shape) -> Option<Table> {
    Table::try_from(shape).ok()
}

/// Of how many pieces of contour a `[[object.piece]]` consists; none where it is no shape.
pub fn piece_count(table: &Table) -> Option<usize> {
    let mut fields = table.clone();
    let name = fields.remove("shape")?;
    fields.remove("friction");
    let shape = Shape::from_fields(name.as_str()?, Value::Table(fields)).ok()?;
    // files are written with absolute paths
    shape.pieces(Path::new("")).ok().map(|pieces| pieces.len())
}

/// Two coordinates.
pub fn point([x, y]: [f64; 2]) -> Value {
    Value::Array(vec![Value::Float(x), Value::Float(y)])
}

/// The number of that name.
pub fn number(table: &Table, name: &str) -> Option<f64> {
    table.get(name).and_then(float)
}

/// The two coordinates of that name.
pub fn two(table: &Table, name: &str) -> Option<[f64; 2]> {
    pair(table.get(name)?)
}

/// The list of two numbers each of that name.
pub fn points(table: &Table, name: &str) -> Option<Vec<[f64; 2]>> {
    table.get(name)?.as_array()?.iter().map(pair).collect()
}

fn pair(value: &Value) -> Option<[f64; 2]> {
    let numbers = value.as_array()?;
    Some([float(numbers.first()?)?, float(numbers.get(1)?)?])
}

fn float(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|number| number as f64))
}

/// An object of a scene as its table: what it is made of, and where it stands.
#[derive(Clone)]
pub struct Object {
    /// `piece`, or `file`.
    pub made_of: Table,
    pub motion: Motion,
    pub reversed: bool,
}

impl Object {
    /// An object of pieces.
    pub fn of_pieces(pieces: Vec<Table>) -> Self {
        let pieces = pieces.into_iter().map(Value::Table).collect();
        let made_of = Table::from_iter([("piece".to_owned(), Value::Array(pieces))]);
        Self { made_of, motion: Motion::IDENTITY, reversed: false }
    }

    /// The table `[[object]]`.
    pub fn table(&self, is_cavity: bool) -> Table {
        let Motion { rotation, translation, scale, mirror } = self.motion;
        let mut table = self.made_of.clone();
        let mut put = |name: &str, value: Value| table.insert(name.to_owned(), value);
        if translation != [0.0, 0.0] {
            put("position", point(translation));
        }
        if rotation != 0.0 {
            put("angle", Value::Float(degrees(rotation)));
        }
        if scale != 1.0 {
            put("scale", Value::Float(scale));
        }
        for (name, flag) in [("mirror", mirror), ("reversed", self.reversed), ("hollow", is_cavity)] {
            if flag {
                put(name, Value::Boolean(true));
            }
        }
        table
    }
}
