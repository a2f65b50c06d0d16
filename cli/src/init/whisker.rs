//! The scene of a whisker: it turns about its follicle past a peg and back.

use rod_files::Whisker;

/// Lengths of the scene over that of the whisker: those of `scenes/whisker.toml`. The peg is where the side of the whisker meets it, and leaves
/// it during protraction.
const PEG: [f64; 2] = [0.15, 0.64];
const PEG_RADIUS: f64 = 0.025;
const PIVOT: f64 = 0.12;
const START: f64 = 0.05;
const STEP: f64 = 0.0025;

/// The text of the scene file.
pub(super) fn scene(whisker: &Whisker) -> String {
    let Whisker { place, length, base_diameter, tip_diameter, youngs_modulus, curvature_coefficient, sources, .. } =
        whisker;
    let animal = whisker.animal.name();
    let [x, y, radius, pivot, start, step] =
        [PEG[0], PEG[1], PEG_RADIUS, PIVOT, START, STEP].map(|part| significant(1e3 * part * length));
    let [length, base, tip] = [1e3 * length, 1e6 * base_diameter, 1e6 * tip_diameter].map(significant);
    let modulus = significant(1e-9 * youngs_modulus);
    let curvature = significant(whisker.mean_curvature());
    let coefficient = significant(*curvature_coefficient);
    let (of_length, of_curvature) = (&sources.length, &sources.curvature);
    let (of_base, of_tip, of_modulus) = (sources.base_diameter, sources.tip_diameter, sources.youngs_modulus);
    format!(
        r#"# The average whisker {place} of a {animal} turns about its follicle: protraction past a peg, and retraction. Single whiskers differ from the
# average; measured numbers are better. Run the scene with `vibrissa sweep` and the name of this file. All fields: docs/scene-files.md.

[rod]
# {of_length}
length = "{length} mm"
# {of_base}
diameter = "{base} um"              # at the base
# {of_tip}
tip_diameter = "{tip} um"
# {of_modulus}
youngs_modulus = "{modulus} GPa"
# {of_curvature}
# The mean along the parabola y = a x^2 with a = {coefficient} 1/m. Positive: bent to the left at rest, seen from the base.
natural_curvature = "{curvature} 1/m"

[[object]]                          # a peg

[[object.piece]]
shape = "circle"
center = ["{x} mm", "{y} mm"]
radius = "{radius} mm"

[sweep]                             # the first leg: the whisker moves to its place
from = [0.0, "-{start} mm"]
to = [0.0, 0.0]
angle = "100 deg"                   # direction of the whisker at its base
step = "{step} mm"                  # distance between reported states

[[sweep.leg]]                       # protraction: clockwise about the follicle, behind the base
pivot = [0.0, "-{pivot} mm"]
turn = "-60 deg"

[[sweep.leg]]                       # retraction
pivot = [0.0, "-{pivot} mm"]
turn = "60 deg"
"#
    )
}

/// A number to four significant digits, without an exponent or zeros at the end.
fn significant(value: f64) -> String {
    let digits = (3.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn four_digits() {
        assert_eq!(
            [32.6, 131.4, 0.081_54, 15.0, 3.34, 2.999_96].map(significant),
            ["32.6", "131.4", "0.08154", "15", "3.34", "3"]
        );
    }
}
