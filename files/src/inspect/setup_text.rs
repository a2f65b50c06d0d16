//! The setup file that a command needs, with comments.

use super::frame::ReactionFrame;
use std::fmt::Write;

/// Components of a wrench that is not complete.
#[derive(Clone, Debug)]
pub(super) struct Components {
    /// Their names, and those of their columns.
    pub columns: Vec<(&'static str, String)>,
    /// Units of forces and moments.
    pub units: [String; 2],
}

/// What a setup must say.
#[derive(Clone, Debug, Default)]
pub(super) struct SetupText {
    /// The components that there are, if not all are.
    pub components: Option<Components>,
    /// The column of the times.
    pub time: Option<String>,
    /// The topic of an MCAP file.
    pub topic: Option<String>,
    /// The frame of the sensor, relative to a sensor that measures loads in the axes of the scene.
    pub frame: Option<ReactionFrame>,
}

impl SetupText {
    pub fn is_needed(&self) -> bool {
        self.components.is_some() || self.topic.is_some() || self.frame.is_some_and(|frame| !frame.is_as_is())
    }

    /// The file.
    pub fn text(&self) -> String {
        let mut text = "# Setup of a sensor, as `vibrissa inspect` understood its recording. docs/sensors.md explains every field.\n".to_owned();
        if let Some(Components { columns: components, units: [force, torque] }) = &self.components {
            let names: Vec<String> = components.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            let rows: Vec<String> = (0..components.len())
                .map(|row| {
                    let cells: Vec<&str> =
                        (0..components.len()).map(|column| if row == column { "1.0" } else { "0.0" }).collect();
                    format!("[{}]", cells.join(", "))
                })
                .collect();
            let _ = write!(
                text,
                "\n[sensor]\n# components that the file has, each its own column\ncomponents = [{}]\nmatrix = [{}]\nforce_unit = \"{force}\"\ntorque_unit = \"{torque}\"\n",
                names.join(", "),
                rows.join(", ")
            );
        }
        let frame = self.frame.unwrap_or(ReactionFrame { swapped: false, turned: [false; 3] });
        let (axes, sense) = mounting(frame);
        let measured = match sense {
            "load" => "it measures what the rod does to it; or reaction: what it does to the rod",
            _ => "it measures what it does to the rod; or load: what the rod does to it",
        };
        let _ = write!(
            text,
            "\n[mounting]\naxes = [\"{}\", \"{}\", \"{}\"] # of the scene, along which x, y, z of the sensor lie{}\nsense = \"{sense}\" # {measured}\nlever = [0.0, 0.0, 0.0] # m, from the sensor's origin to the clamp, in its axes: measure it\n",
            axes[0],
            axes[1],
            axes[2],
            if self.frame.is_some() { ", as the physics prefers" } else { ": not checked" },
        );
        if self.components.is_some() || self.topic.is_some() || self.time.is_some() {
            text += "\n[recording]\n";
        }
        if let Some(Components { columns: components, .. }) = &self.components {
            let names: Vec<String> = components.iter().map(|(_, column)| toml_string(column)).collect();
            let _ = writeln!(text, "columns = [{}]", names.join(", "));
        }
        if let Some(time) = &self.time {
            let _ = writeln!(text, "time = {}", toml_string(time));
        }
        if let Some(topic) = &self.topic {
            let _ = writeln!(text, "topic = {}", toml_string(topic));
        }
        text += "\n[tare]\nseconds = 1.0 # of the free rod, at the start; 0 for none\n";
        text
    }
}

fn toml_string(text: &str) -> String {
    let escaped: String = text
        .chars()
        .map(|letter| match letter {
            '"' | '\\' => format!("\\{letter}"),
            letter if letter.is_control() => " ".to_owned(),
            letter => letter.to_string(),
        })
        .collect();
    format!("\"{escaped}\"")
}

/// Axes and sense of a sensor whose loads, turned, are in this frame: those that are right-handed.
fn mounting(frame: ReactionFrame) -> ([&'static str; 3], &'static str) {
    // signs of the reactions by the columns; those of loads are the opposite
    let [x, y, z] = frame.turned.map(|turned| if turned { 1 } else { -1 });
    let handed = if frame.swapped { -x * y } else { x * y };
    // the moment about z has the sign of the sense times that of the axis
    let sense = z * handed;
    let axis = |name: [&'static str; 2], sign: i32| if sign * sense > 0 { name[0] } else { name[1] };
    let (along_x, along_y) = (axis(["x", "-x"], x), axis(["y", "-y"], y));
    let axes = if frame.swapped { [along_y, along_x] } else { [along_x, along_y] };
    let third = if handed > 0 { "z" } else { "-z" };
    ([axes[0], axes[1], third], if sense > 0 { "reaction" } else { "load" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Setup;
    use vibrissa::Pose;
    use vibrissa::hw::{OutOfPlane, Wrench, WrenchSample};
    use vibrissa::rod::Reactions;

    /// Each of the sixteen frames of a sensor becomes a mounting that gives the reactions back.
    #[test]
    fn every_frame_has_a_mounting() {
        for number in 0..16_u8 {
            let frame =
                ReactionFrame { swapped: number & 8 > 0, turned: [number & 1 > 0, number & 2 > 0, number & 4 > 0] };
            let text = SetupText { frame: Some(frame), ..SetupText::default() }.text();
            let setup = Setup::parse("s.toml".as_ref(), &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let wrench = Wrench { force: [0.1, 0.3, 0.0], torque: [0.0, 0.0, 0.7] };
            let found =
                setup.mounting.reactions(&WrenchSample::new(0.0, wrench), Pose { x: 0.0, y: 0.0, phi: 1.0 }).reactions;
            // what a sensor in the axes of the scene gives, and the frame of that
            let plain = Reactions { f0x: -0.1, f0y: -0.3, m0z: -0.7 };
            let (x, y) = if frame.swapped { (plain.f0y, plain.f0x) } else { (plain.f0x, plain.f0y) };
            let sign = frame.turned.map(|turned| if turned { -1.0 } else { 1.0 });
            let expected = Reactions { f0x: sign[0] * x, f0y: sign[1] * y, m0z: sign[2] * plain.m0z };
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            assert!(
                near(found.f0x, expected.f0x) && near(found.f0y, expected.f0y) && near(found.m0z, expected.m0z),
                "{frame:?}: {found:?}, expected {expected:?}\n{text}"
            );
            let _ = OutOfPlane::<f64>::default();
        }
    }
}
