//! A logarithmic axis in pixels.

/// Fewest pixels from one number to the next.
const APART: f64 = 84.0;

/// Whole decades, from one power of ten to another, along so many pixels.
#[derive(Clone, Copy)]
pub struct Decades {
    pub from: i32,
    pub to: i32,
    pub start: f64,
    pub end: f64,
}

impl Decades {
    /// The decades that hold all values.
    pub fn of(values: impl Iterator<Item = f64>, (start, end): (f64, f64)) -> Self {
        let (least, most) = values
            .map(f64::log10)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        // a little room, so that nothing lies on the frame
        let (from, to) = ((least - 0.15).floor() as i32, (most + 0.15).ceil() as i32);
        Self { from, to: to.max(from + 1), start, end }
    }

    pub fn pixel(&self, value: f64) -> f64 {
        let part = (value.log10() - f64::from(self.from)) / f64::from(self.to - self.from);
        self.start + part * (self.end - self.start)
    }

    /// All decades: where, and, of so many that can be read, what to write there.
    pub fn ticks(&self) -> impl Iterator<Item = (f64, Option<String>)> + '_ {
        let decade = (self.end - self.start).abs() / f64::from(self.to - self.from);
        let every = (APART / decade).ceil() as i32;
        (self.from..=self.to).map(move |power| {
            let name = (power % every == 0).then(|| format!("10{}", superscript(power)));
            (self.pixel(10_f64.powi(power)), name)
        })
    }
}

fn superscript(power: i32) -> String {
    let letter = |letter: char| match letter {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        digit => char::from_u32(0x2070 + u32::from(digit) - u32::from('0')).unwrap_or(digit),
    };
    power.to_string().chars().map(letter).collect()
}
