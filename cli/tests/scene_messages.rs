//! Every mistake in a scene file is answered with its place, the value and what was expected.

use crate::common::{SCENE, edited, refused_beside, with_objects};

/// Checks that the message for a scene holds all these parts.
fn says(scene: &str, parts: &[&str]) {
    says_beside(scene, &[], parts);
}

/// The same for a scene with other files beside it.
fn says_beside(scene: &str, files: &[(&str, &str)], parts: &[&str]) {
    let message = refused_beside(scene, files);
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert_eq!(message.trim_end().lines().count(), 1, "one line where nobody looks at a terminal: {message}");
}

#[test]
fn a_missing_field() {
    says(&edited("length = 0.1\n", ""), &["scene.toml:1:1: rod: ", "missing field `length`"]);
    says(&edited("vertex = [0.03, 0.0]\n", ""), &["scene.toml:11:", "contour.piece[2]", "missing field `vertex`"]);
    says(&edited("shape = \"parabola\"\n", ""), &["scene.toml:6:", "contour.piece[1]", "missing field `shape`"]);
    says(&edited("to = [0.03, -0.04]\n", ""), &["scene.toml:16:1: sweep: ", "missing field `to`"]);
    says(&edited("step = 1e-3\n", ""), &["scene.toml:16:1: sweep: ", "missing field `step` (m)"]);
    says(&edited("youngs_modulus = 206e9\n", ""), &["rod: ", "missing field `youngs_modulus`", "bending_stiffness"]);
    says(&edited("diameter = 0.5e-3\n", ""), &["rod: ", "missing field `diameter`"]);
    says("", &["scene.toml:1:1: ", "missing tables [rod], [sweep], [[object]]; `vibrissa init` writes a scene"]);
    let nothing = "missing field `to`, expected it, or angle_to for a clamp that turns on the spot";
    says(&edited("to = [0.03, -0.04]\n", ""), &["scene.toml:16:1: sweep: ", nothing]);
}

#[test]
fn all_mistakes_of_a_table_in_one_message() {
    let rod = edited("length = 0.1\ndiameter = 0.5e-3\n", "diametre = \"thin\"\n");
    says(&rod, &["scene.toml:1:1: rod: missing field `length`; unknown field `diametre`, did you mean `diameter`?"]);
    let rod = edited("length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n", "yield_stress = -1\n");
    let all = "missing field `length`; missing `diameter` and `youngs_modulus`, or `bending_stiffness`; \
               yield_stress is -1, expected a positive, finite number";
    says(&rod, &["scene.toml:1:1: rod: ", all]);
    let rod = edited("length = 0.1\ndiameter = 0.5e-3\n", "length = \"long\"\ndiameter = \"0.5 mN\"\n");
    let all = "`mN` is a unit of force, expected one of length: m, mm, um, cm, in, ft (line 3); length is the text \"long\", expected a number (line 2)";
    says(&rod, &["scene.toml:1:1: rod: diameter is \"0.5 mN\": ", all]);
    let path = edited("from = [0.07, -0.04]\nto = [0.03, -0.04]\n", "").replace("1e-3", "-1e-3");
    let all = "missing field `from`; missing `to`, or `angle_to` for a clamp that turns on the spot; step is -0.001, expected a positive";
    says(&path, &["scene.toml:16:1: sweep: ", all]);
    let path = edited("from = [0.07, -0.04]\n", "from = [0,07, -0,04]\n").replace("angle = 90.0", "turn = 90.0");
    says(&path, &["scene.toml:17:9: the value is `0,07`, expected a decimal point"]);
    let object = square("angle = true\nscale = 0").replace("points = ", "edges = ");
    says(
        &object,
        &["scene.toml:6:1: object[1]: angle is true, expected a number (line ", "; scale is 0, expected a positive"],
    );
    let arc = piece("arc", "radius = [1]\nend = 3");
    let all =
        "missing field `center`; unknown field `end`, expected one of `center`, `radius`, `from_angle`, `to_angle`";
    says(&arc, &["scene.toml:6:1: contour.piece[1]: ", all, "; radius is a list, expected a number"]);
    let leg = SCENE.to_owned() + "[[sweep.leg]]\nturn = \"90\"\npivot = [1]\n";
    says(
        &leg,
        &[
            "sweep.leg[1]: pivot is a list of 1, expected two numbers: [x, y] (line ",
            "; turn is the text \"90\", expected a number",
        ],
    );
}

#[test]
fn a_wrong_unit() {
    let expected = "length is \"100 mN\": `mN` is a unit of force, expected one of length: m, mm, um, cm, in, ft";
    says(&edited("0.1", "\"100 mN\""), &["scene.toml:2:10: rod.length: ", expected]);
    let expected =
        "youngs_modulus is \"206 mm\": `mm` is a unit of length, expected one of stress: Pa, kPa, MPa, GPa, psi";
    says(&edited("206e9", "\"206 mm\""), &["scene.toml:4:18: rod.youngs_modulus: ", expected]);
    let expected = "from is \"-4 kg\": `kg` is a unit of mass, expected one of length";
    says(&edited("[0.07, -0.04]", "[0.07, \"-4 kg\"]"), &["scene.toml:17:15: sweep.from[2]: ", expected]);
    let expected = "angle is \"90 furlongs\": `furlongs` is not a known unit, expected one of angle: rad, mrad, deg";
    says(&edited("90.0", "\"90 furlongs\""), &["scene.toml:19:9: sweep.angle: ", expected]);
    let expected = "coefficient is \"50 m\": `m` is a unit of length, expected one of curvature: 1/m, 1/mm, 1/cm";
    says(&edited("50.0", "\"50 m\""), &["contour.piece[1].coefficient: ", expected]);
    says(&edited("0.1", "\"0,1 m\""), &["rod.length: ", "expected a decimal point: \"0.1 m\""]);
    // what is wrong with the number is said of it in the unit of the file
    says(&edited("0.1", "\"-40 mm\""), &["scene.toml:2:10: rod.length: length is -0.04, expected a positive"]);
}

#[test]
fn an_unknown_field() {
    says(&edited("length", "lenght"), &["scene.toml:2:1: rod.lenght: ", "unknown field `lenght`", "mean `length`?"]);
    // these were read field by field, or missed values that nobody had asked for
    for name in ["contact", "rod", "sweep", "contour", "clamp"] {
        let list = SCENE.replacen(&format!("[{name}]\n"), &format!("[[{name}]]\n"), 1);
        let list = if name == "contour" { list.replacen("[[contour.", "[[contour]]\n[[contour.", 1) } else { list };
        let list = if list == SCENE { format!("{SCENE}\n[[{name}]]\nfriction = 0.3\n") } else { list };
        says(&list, &[&format!(": {name}"), &format!("expected [{name}] once; several may be [[object]]")]);
    }
    let section = edited("[[contour", "[[section]]\nlength = 0.1\n[[contour");
    says(&section, &["scene.toml:6:3: section: unknown field `section`", "did you mean [[rod.section]]?"]);
    says(
        &edited("coefficient", "curvature"),
        &[
            "scene.toml:6:1: contour.piece[1]: missing field `coefficient`; unknown field `curvature`, expected one of `vertex`",
        ],
    );
    says(&edited("parabola", "parbola"), &["scene.toml:7:9: contour.piece[1].shape: ", "parbola", "`parabola`"]);
    says(&edited("[sweep]", "[swep]"), &["scene.toml:16:", "swep: ", "unknown field `swep`"]);
}

#[test]
fn a_wrong_type() {
    says(&edited("0.1", "\"long\""), &["scene.toml:2:10: rod.length: ", "the text \"long\"", "expected a number"]);
    says(
        &edited("[0.03, 0.0]", "0.03"),
        &["scene.toml:13:10: contour.piece[2].vertex: ", "vertex is 0.03, expected two numbers: [x, y]"],
    );
    says(
        &edited("[0.07, -0.04]", "[0.07]"),
        &["scene.toml:17:8: sweep.from: ", "found a list of 1, expected two numbers"],
    );
    says(&edited("[0.07, -0.04]", "[0.07, 1.0, 2.0]"), &["sweep.from: ", "found a list of 3, expected two numbers"]);
    says(
        &edited("\"parabola\"", "3"),
        &["scene.toml:7:9: contour.piece[1].shape: ", "of the type integer", "name of a shape"],
    );
    says(&edited("1e-3", "[1"), &["scene.toml:20:", "array"]);
}

#[test]
fn a_key_given_twice() {
    says(&edited("length = 0.1\n", "length = 0.1\nlength = 0.2\n"), &["scene.toml:3:1: `length` is given twice"]);
}

#[test]
fn a_number_that_toml_does_not_take() {
    let unit = "the value is `100 mm`, expected a number, or a text in quotes: \"100 mm\"";
    says(&edited("length = 0.1", "length = 100 mm"), &["scene.toml:2:10: ", unit]);
    says(
        &edited("50.0", "1e400"),
        &["scene.toml:9:15: contour.piece[1].coefficient: ", "overflowed, expected at most 1.7e308"],
    );
}

#[test]
fn a_decimal_comma_and_a_quoted_number() {
    says(&edited("0.1", "0,1  # m"), &["scene.toml:2:10: the value is `0,1`, expected a decimal point: `0.1`"]);
    says(&edited("[0.07, -0.04]", "[0,07, -0,04]"), &["scene.toml:17:9: ", "`0,07`", "`0.07`"]);
    says(
        &edited("[0.07, -0.04]", "[1,5, -2,5]"),
        &["sweep.from: found a list of 4, expected two numbers", "decimals have a point"],
    );
    says(&edited("0.1", "\"0.1\""), &["scene.toml:2:10: rod.length: ", "write it without quotes: 0.1"]);
    says(&edited("0.1", "\"0,1\""), &["scene.toml:2:10: rod.length: ", "write it without quotes: 0.1"]);
}

#[test]
fn a_clamp_inside_an_object_in_the_first_pose() {
    let inside = edited("from = [0.07, -0.04]", "from = [0.0, 0.05]");
    says(&inside, &["scene.toml:17:8: sweep.from: the clamp is inside an object in the first pose"]);
}

#[test]
fn a_length_that_is_none() {
    says(
        &edited("0.1", "-0.1"),
        &["scene.toml:2:10: rod.length: ", "length is -0.1, expected a positive, finite number"],
    );
    says(&edited("0.1", "0.0"), &["scene.toml:2:10: rod.length: ", "length is 0, expected a positive"]);
    says(&edited("0.5e-3", "-5e-4"), &["scene.toml:3:12: rod.diameter: ", "diameter is -0.0005, expected a positive"]);
    let expected = "diameter is 0.5 m, expected at most the length, 0.1 m";
    let meant = "; 0.5 mm would be 5e-4, or \"0.5 mm\"";
    says(&edited("0.5e-3", "0.5"), &["scene.toml:3:12: rod.diameter: ", expected, meant]);
    let meant = "diameter is 0.2 m, expected at most the length, 0.1 m; 0.2 mm would be 2e-4, or \"0.2 mm\"";
    says(&edited("0.5e-3", "0.2"), &["scene.toml:3:12: rod.diameter: ", meant]);
    says(&edited("206e9", "0"), &["scene.toml:4:18: rod.youngs_modulus: ", "youngs_modulus is 0, expected a positive"]);
    let stiffness = edited("diameter = 0.5e-3\nyoungs_modulus = 206e9", "bending_stiffness = 0.0");
    says(&stiffness, &["scene.toml:3:21: rod.bending_stiffness: ", "is 0, expected a positive"]);
    says(&edited("206e9", "206e9\nyield_stress = -1.0"), &["scene.toml:5:16: rod.yield_stress: ", "is -1, expected"]);
    says(&edited("206e9", "206e9\nbending_stiffness = 1.0"), &["scene.toml:5:21: ", "either it or those two"]);
}

#[test]
fn a_number_that_is_none() {
    says(
        &edited("0.1", "nan"),
        &["scene.toml:2:10: rod.length: ", "length is NaN, expected a positive, finite number"],
    );
    says(&edited("0.1", "inf"), &["scene.toml:2:10: rod.length: ", "length is inf, expected a positive, finite"]);
    says(&edited("[0.03, 0.0]", "[nan, 0.0]"), &["scene.toml:13:10: contour.piece[2].vertex: ", "NaN", "finite"]);
    says(&edited("50.0", "nan"), &["scene.toml:9:15: contour.piece[1].coefficient: ", "NaN", "finite"]);
    says(&edited("[0.07, -0.04]", "[0.07, nan]"), &["scene.toml:17:8: sweep.from: ", "NaN", "finite"]);
    says(&edited("[0.03, -0.04]", "[nan, 0.0]"), &["scene.toml:18:6: sweep.to: ", "NaN", "finite"]);
    says(&edited("90.0", "nan"), &["scene.toml:19:9: sweep.angle: ", "NaN", "degrees"]);
    says(&edited("90.0", "90\nangle_to = inf"), &["scene.toml:20:12: sweep.angle_to: ", "inf", "degrees"]);
    says(&edited("1e-3", "nan"), &["scene.toml:20:8: sweep.step: ", "step is NaN, expected a positive, finite"]);
}

#[test]
fn a_number_with_hundreds_of_digits() {
    says(&edited("0.5e-3", "1e300"), &["rod.diameter: ", "diameter is 1e300 m, expected at most the length"]);
    let whole = "the value is 99999999999999999999, expected a number of this size with a decimal point";
    says(&edited("0.1", "99999999999999999999"), &["scene.toml:2:10: rod.length: ", whole]);
    says(&edited("50.0", "99999999999999999999"), &["contour.piece[1].coefficient: ", whole]);
}

/// What is wrong may come from a number in another unit elsewhere.
#[test]
fn an_implausible_number_is_named_before_an_error() {
    let modulus = "youngs_modulus = 206e9\n";
    let bent = edited("length = 0.1", "length = 30").replace(modulus, &format!("{modulus}natural_curvature = 20.0\n"));
    let length =
        "length is 30 m, expected 1e-4 to 1e1 m; 30 mm would be 0.03, or \"30 mm\"; besides, rod.natural_curvature: ";
    says(&bent, &["scene.toml:2:10: rod.length: ", length]);
    let soft = edited("206e9", "206").replace("step = 1e-3\n", "");
    let modulus = "youngs_modulus is 206 Pa, expected 1e4 to 2e12 Pa; 206 GPa would be 2.06e11, or \"206 GPa\"; besides, sweep: missing field `step`";
    says(&soft, &["scene.toml:4:18: rod.youngs_modulus: ", modulus]);
    let sections = "[[rod.section]]\nlength = 60\nbending_stiffness = 6e-4\n[[rod.section]]\nlength = 40\nbending_stiffness = 1e-4\n";
    let sections = edited("diameter = 0.5e-3\nyoungs_modulus = 206e9\n", sections);
    let sum = "add up to 100 m, expected 0.1 m, the length of the rod; are they in mm?";
    says(&sections, &["scene.toml:4:10: rod.section[1].length: ", sum]);
    let far = edited("[0.07, -0.04]", "[70, -40]").replace("step = 1e-3", "step = 1e-6");
    says(
        &far,
        &[
            "sweep.to: the path is 806 lengths of the rod long; are from and to in m?; besides, sweep.step: ",
            "asks for 8.1e7 states",
        ],
    );
}

#[test]
fn a_recording_is_no_scene() {
    let table = "# from the laboratory\nx0,y0,phi0,f0x,f0y,m0z\n0.07,-0.04,1.57,0,0,0\n";
    says(table, &["scene.toml:2:1: this is a table (CSV), expected a TOML file; ", "vibrissa reconstruct", "--rod"]);
}

#[test]
fn an_angle_beyond_all_turns() {
    let expected = "is 9000 degrees, expected at most 5729 degrees either way";
    says(&edited("90.0", "9e3"), &["scene.toml:19:9: sweep.angle: ", "angle ", expected]);
    says(&edited("90.0", "90\nangle_to = 9000"), &["scene.toml:20:12: sweep.angle_to: ", "angle_to ", expected]);
}

#[test]
fn a_contour_that_is_none() {
    // The second bump lies in the solid of the first one, or left of it.
    let lifted = edited("vertex = [0.03, 0.0]", "vertex = [0.0, 1.0]");
    says(&lifted, &["scene.toml:11:", "contour.piece[2]: ", "piece 1", "piece 2", "expected a crossing"]);
    let without = SCENE[..SCENE.find("[[contour").unwrap()].to_owned() + &SCENE[SCENE.find("[sweep]").unwrap()..];
    says(&without, &["scene.toml", "missing field `contour`"]);
    let empty = without.replace("[sweep]", "[contour]\npiece = []\n[sweep]");
    says(&empty, &["scene.toml:6:", "contour: ", "at least one piece"]);
}

#[test]
fn a_sweep_that_is_none() {
    says(
        &edited("to = [0.03", "to = [0.07"),
        &["scene.toml:18:6: sweep.to: ", "ends where it starts", "expected two different"],
    );
    says(&edited("1e-3", "0.0"), &["scene.toml:20:8: sweep.step: ", "step is 0, expected a positive"]);
    says(&edited("1e-3", "-1e-3"), &["scene.toml:20:8: sweep.step: ", "step is -0.001, expected a positive"]);
    says(
        &edited("1e-3", "1e-12"),
        &["scene.toml:20:8: sweep.step: ", "step is 1e-12", "4.0e10 states, expected at most 1e6"],
    );
    says(
        &edited("step = 1e-3", "step_angle = 1.0"),
        &["sweep.step_angle: ", "step_angle is 1, but the clamp moves", "step in m"],
    );
    let turning = edited("to = [0.03", "to = [0.07").replace("90.0", "90.0\nangle_to = 120.0");
    says(&turning, &["scene.toml:21:8: sweep.step: ", "turns without moving", "step_angle"]);
    let turning = turning.replace("step = 1e-3", "step_angle = -1.0");
    says(&turning, &["scene.toml:21:14: sweep.step_angle: ", "step_angle is -1, expected a positive"]);
}

/// A scene with a contour of one piece with these fields, on lines 8 and after.
fn piece(shape: &str, fields: &str) -> String {
    with_objects(&format!("[[contour.piece]]\nshape = \"{shape}\"\n{fields}\n"))
}

/// A scene with a square that runs counterclockwise and these other fields, on lines 7 and after.
fn square(fields: &str) -> String {
    let points = "points = [[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01]]";
    with_objects(&format!("[[object]]\n{fields}\n[[object.piece]]\nshape = \"polygon\"\n{points}\n"))
}

#[test]
fn too_few_points() {
    let at = ["scene.toml:8:10: contour.piece[1].points: "];
    says(&piece("polygon", "points = [[0, 0], [1, 0]]"), &[at[0], "a polygon needs at least 3 points, got 2"]);
    says(&piece("polygon", "points = [[0, 0], [1, 0], [0, 0]]"), &[at[0], "a polygon needs at least 3 points, got 2"]);
    let open = piece("polygon", "points = [[0, 0]]\nclosed = false");
    says(&open, &[at[0], "a polyline needs at least 2 points, got 1"]);
    says(&piece("spline", "points = [[0, 0]]"), &[at[0], "a spline needs at least 2 points, got 1"]);
    let closed = piece("spline", "points = [[0, 0], [1, 0]]\nend = \"periodic\"");
    says(&closed, &[at[0], "a closed spline needs at least 3 points, got 2"]);
}

#[test]
fn points_that_are_none() {
    for shape in ["polygon", "spline"] {
        let repeated = piece(shape, "points = [[0, 0], [1, 0], [1, 0], [0, 1]]");
        says(
            &repeated,
            &["scene.toml:8:27: contour.piece[1].points[3]: ", "point 3 is (1, 0), the same as the one before it"],
        );
        let nan = piece(shape, "points = [[0, 0], [1, nan], [1, 1]]");
        says(&nan, &["scene.toml:8:19: contour.piece[1].points[2]", "point 2 is (1, NaN), expected finite numbers"]);
        let three = piece(shape, "points = [[0, 0], [1, 0, 0], [1, 1]]");
        says(&three, &["scene.toml:8:10: contour.piece[1].points: ", "point 2 is a list of 3, expected two numbers"]);
        let words = piece(shape, "points = [[0, 0], [1, \"0\"], [1, 1]]");
        says(&words, &["scene.toml:8:23: contour.piece[1].points[2][2]: ", "the text \"0\"", "expected a number"]);
    }
    says(
        &piece("line", "from = [1, 2]\nto = [1, 2]"),
        &["scene.toml:9:6: contour.piece[1].to: ", "the same point (1, 2), expected two different points"],
    );
    says(&piece("line", "from = [nan, 2]\nto = [1, 2]"), &["contour.piece[1].from: ", "NaN", "finite"]);
}

#[test]
fn a_contour_that_crosses_itself() {
    let expected = "edge 1 crosses edge 3 at (0.5, 0.5), expected a contour that does not cross itself; put the points in the order";
    for closed in ["", "\nclosed = false"] {
        let tie = piece("polygon", &format!("points = [[0, 0], [1, 1], [1, 0], [0, 1]]{closed}"));
        says(&tie, &["scene.toml:6:1: contour.piece[1]: ", expected]);
    }
    // Three quarters of a circle, and a line out again.
    let arc = "[[contour.piece]]\nshape = \"arc\"\ncenter = [0, 0]\nradius = 1\nfrom_angle = 0\nto_angle = 270\n";
    let line = "[[contour.piece]]\nshape = \"line\"\nfrom = [0, -1]\nto = [0.6, 1.8]\n";
    says(
        &with_objects(&format!("{arc}{line}")),
        &[
            "scene.toml:12:1: contour.piece[2]: ",
            "piece 1 crosses piece 2 at (0.409756",
            "trim the pieces, or move them apart",
        ],
    );
    let curve = piece("spline", "points = [[0, 0], [2, 1], [2, 0], [0, 1]]");
    says(&curve, &["scene.toml:6:1: contour.piece[1]: ", "piece 1 crosses itself at ("]);
}

#[test]
fn edges_are_counted_within_their_piece() {
    let step = "[[contour.piece]]\nshape = \"polygon\"\nclosed = false\npoints = [[0, 0], [1, 0], [1, 1]]\n";
    let line = "[[contour.piece]]\nshape = \"line\"\nfrom = [7, 7]\nto = [8, 8]\n";
    says(
        &with_objects(&format!("{step}{line}")),
        &[
            "scene.toml:10:1: contour.piece[2]: ",
            "piece 2 ends at (1, 1)",
            "number 2 here is edge 2 of piece[1]; number 3 here is piece[2]",
        ],
    );
}

#[test]
fn a_contour_that_runs_the_wrong_way() {
    let clockwise = square("mirror = true\nreversed = true");
    says(
        &clockwise,
        &["scene.toml:6:1: object[1]: ", "runs clockwise", "reversed = true, or hollow = true for a cavity"],
    );
    says(
        &square("hollow = true"),
        &["scene.toml:7:10: object[1].hollow: ", "runs counterclockwise", "leave hollow out, or reverse"],
    );
    let open = edited("[[contour.piece]]", "[contour]\nhollow = true\n[[contour.piece]]");
    says(&open, &["scene.toml:7:10: contour.hollow: ", "not closed"]);
}

#[test]
fn a_radius_or_an_arc_that_is_none() {
    let arc = |edit: (&str, &str)| {
        piece("arc", &"center = [0, 0]\nradius = 1\nfrom_angle = 0\nto_angle = 90".replace(edit.0, edit.1))
    };
    for (radius, number) in [("0", "0"), ("-0.5", "-0.5")] {
        says(
            &arc(("radius = 1", &format!("radius = {radius}"))),
            &["scene.toml:9:10: contour.piece[1].radius: ", &format!("radius is {number}, expected a positive number")],
        );
    }
    let thin = "the radius is 1e-300 m, expected at least 1.0e-13 m, 1e-12 lengths of the rod";
    says(&arc(("radius = 1", "radius = 1e-300")), &["scene.toml:9:10: contour.piece[1].radius: ", thin]);
    says(&arc(("radius = 1", "radius = nan")), &["contour.piece[1].radius: ", "NaN", "finite"]);
    says(&arc(("[0, 0]", "[0, inf]")), &["contour.piece[1].center: ", "inf", "finite"]);
    says(&arc(("= 90", "= nan")), &["scene.toml:11:12: contour.piece[1].to_angle: ", "NaN", "finite"]);
    let expected = "expected two different angles at most 360 degrees apart";
    says(
        &arc(("= 90", "= 400")),
        &["scene.toml:11:12: contour.piece[1].to_angle: ", "from 0 to 400 degrees", expected],
    );
    says(&arc(("= 90", "= 0")), &["contour.piece[1].to_angle: ", "from 0 to 0 degrees", expected]);

    let ellipse = |edit: (&str, &str)| {
        let fields = "center = [0, 0]\nradii = [2, 1]\nrotation = 5\nfrom_angle = 0\nto_angle = 90";
        piece("ellipse", &fields.replace(edit.0, edit.1))
    };
    says(&ellipse(("[2, 1]", "[2, -1]")), &["scene.toml:9:9: contour.piece[1].radii: ", "radius is -1", "positive"]);
    says(&ellipse(("= 5", "= nan")), &["scene.toml:10:12: contour.piece[1].rotation: ", "NaN", "finite"]);
    says(&ellipse(("= 90", "= 361")), &["contour.piece[1].to_angle: ", "from 0 to 361 degrees", expected]);
}

#[test]
fn ends_in_the_wrong_order() {
    let parabola = |ends: &str| piece("parabola", &format!("vertex = [0, 0]\ncoefficient = 5\n{ends}"));
    says(
        &parabola("from_x = 0.2\nto_x = 0.1"),
        &["scene.toml:11:8: contour.piece[1].to_x: ", "runs from 0.2 to 0.1, expected the start to be less"],
    );
    says(&parabola("from_x = nan"), &["scene.toml:10:10: contour.piece[1].from_x: ", "NaN", "finite"]);
    says(&parabola("to_x = -inf"), &["scene.toml:10:8: contour.piece[1].to_x: ", "-inf"]);
}

#[test]
fn a_spline_that_is_none() {
    let spline = |fields: &str| piece("spline", &format!("points = [[0, 0], [1, 0], [2, 1]]\n{fields}"));
    says(&spline("end = \"free\""), &["scene.toml:9:7: contour.piece[1].end: ", "`free`", "`natural`", "`clamped`"]);
    says(&spline("to_angle = 3"), &["scene.toml:9:12: contour.piece[1].to_angle: ", "end = \"clamped\""]);
    let nan = spline("end = \"clamped\"\nfrom_angle = nan");
    says(&nan, &["scene.toml:10:14: contour.piece[1].from_angle: ", "NaN", "finite"]);
    says(&spline("smoothing = -1e-3"), &["scene.toml:9:13: contour.piece[1].smoothing: ", "is -0.001", "not less"]);
    let both = spline("smoothing = 1e-3\nend = \"periodic\"");
    says(&both, &["scene.toml:9:13: contour.piece[1].smoothing: ", "expected natural ends"]);
}

#[test]
fn a_table_of_points_that_is_none() {
    for shape in ["polygon", "spline"] {
        let scene = piece(shape, "file = \"points.csv\"");
        let at = "scene.toml:8:8: contour.piece[1].file: ";
        let with = |points: &str, parts: &[&str]| {
            says_beside(&scene, &[("points.csv", points)], &[&[at][..], parts].concat());
        };
        with("x,y\n0,0\n1,one\n", &["points.csv:3: column y is \"one\", expected a finite number"]);
        with("x,y\n0,0\nnan,1\n", &["points.csv:3: column x is \"nan\", expected a finite number"]);
        with("x,z\n0,0\n", &["points.csv: no column y in the header \"x,z\", expected columns named x and y"]);
        with("x,y\n0,0\n1,0\n\n1,0\n", &["points.csv:5: point 3 is (1, 0), the same as the one before it"]);
        with("x,y\n0,0\n", &["points.csv: a ", "needs at least", "got 1"]);
        says(&scene, &[at, "cannot read points.csv: No such file"]);
    }
}

#[test]
fn points_from_two_places_or_none() {
    for shape in ["polygon", "spline"] {
        let both = piece(shape, "points = [[0, 0], [1, 0]]\nfile = \"points.csv\"");
        says(&both, &["scene.toml:9:8: contour.piece[1].file: ", "given beside points, expected one of them"]);
        let neither = piece(shape, "");
        says(&neither, &["scene.toml:6:1: contour.piece[1]: ", "missing field `points` or `file`"]);
    }
}

#[test]
fn a_drawing_that_is_none() {
    let drawing = |body: &str| format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{body}</svg>");
    let from = |fields: &str, body: &str, parts: &[&str]| {
        says_beside(&piece("svg", fields), &[("drawing.svg", &drawing(body))], parts);
    };
    let file = "file = \"drawing.svg\"\nscale = 1e-3";
    let at = "scene.toml:8:8: contour.piece[1].file: ";
    from(file, "<circle r=\"1\"/>", &[at, "drawing.svg: no `path` element, expected one; convert circles"]);
    let two = "<path id=\"a\" d=\"M0 0h1\"/><path id=\"b\" d=\"M0 0h1\"/>";
    from(file, two, &[at, "2 `path` elements (a, b), expected one; name one of them with `id`"]);
    let id = format!("{file}\nid = \"c\"");
    from(&id, two, &["scene.toml:10:6: contour.piece[1].id: ", "no `path` element with the id \"c\"", "a, b"]);
    let moved = "<g transform=\"scale(2)\"><path d=\"M0 0h1\"/></g>";
    from(file, moved, &[at, "the element `g`", "the transform \"scale(2)\", which is not applied"]);
    from(file, "<path d=\"M0 0\"/>", &[at, "drawing.svg: the path is empty"]);
    from(file, "<path d=\"M0 0h1M2 2h1\"/>", &[at, "drawing.svg: the path has 2 subpaths, expected one"]);
    from(file, "<path d=\"M0 0h1\"", &[at, "drawing.svg:1: "]);
    says(&piece("svg", file), &[at, "cannot read drawing.svg: "]);

    let path = |path: &str| piece("svg", &format!("path = \"{path}\"\nscale = 1e-3"));
    says(&path("M0 0 K"), &["scene.toml:8:8: contour.piece[1].path: ", "cannot be read", "\"K\""]);
    says(&path("M0 0 C0 0 1 1 2 0"), &["contour.piece[1].path: ", "segment 1 of the path", "stands still"]);
    let scale = |scale: &str| piece("svg", &format!("path = \"M0 0h1\"{scale}"));
    says(&scale("\nscale = 0.0"), &["scene.toml:9:9: contour.piece[1].scale: ", "scale is 0, expected a positive"]);
    says(&scale("\nscale = nan"), &["contour.piece[1].scale: ", "scale is NaN"]);
    says(&scale(""), &["contour.piece[1]: ", "missing field `scale`"]);
    says(&scale("\nid = \"a\"\nscale = 1"), &["contour.piece[1].id: ", "given beside path"]);
    says(&piece("svg", "scale = 1"), &["contour.piece[1]: ", "missing field `file` or `path`"]);
}

#[test]
fn an_object_that_is_none() {
    says(
        &with_objects("[[object]]\nangle = 3"),
        &["scene.toml:6:1: object[1]: ", "neither pieces nor a file, expected at least one piece or a file"],
    );
    says(&with_objects(""), &["missing field `contour`, expected one [contour], or an [[object]] for each object"]);
    says(
        &square("postion = [0, 0]"),
        &["scene.toml:7:1: object[1].postion: ", "unknown field", "`position`", "`piece`"],
    );
    says(&square("position = [0, nan]"), &["scene.toml:7:12: object[1].position: ", "NaN", "finite"]);
    says(&square("position = [0]"), &["scene.toml:7:12: object[1].position: ", "found a list of 1"]);
    says(&square("angle = inf"), &["scene.toml:7:9: object[1].angle: ", "angle is inf", "degrees"]);
    says(&square("scale = -2"), &["scene.toml:7:9: object[1].scale: ", "scale is -2, expected a positive", "mirror"]);
    says(&square("scale = nan"), &["scene.toml:7:9: object[1].scale: ", "scale is NaN"]);
    says(
        &with_objects("[[object]]\npiece = 3"),
        &["scene.toml:7:9: object[1].piece: ", "the value is 3, expected a list"],
    );
    says(&with_objects("[[object]]\npiece = [3]"), &["object[1].piece[1]: ", "integer", "a table of fields"]);
    says(
        &with_objects("[[object.piece]]\nshape = \"line\""),
        &["scene.toml:6:3: object: ", "expected [[object]] before the first [[object.piece]]"],
    );
    // The second object is told from the first.
    let second = square("") + "[[object]]\nscale = 0.0\n";
    says(&second, &["object[2].scale: ", "scale is 0"]);
}

#[test]
fn a_file_of_shapes_that_is_none() {
    let scene = with_objects("[[object]]\nfile = \"object.json\"");
    let at = "scene.toml:7:8: object[1].file: ";
    let with = |json: &str, parts: &[&str]| says_beside(&scene, &[("object.json", json)], &[&[at][..], parts].concat());
    says(&scene, &[at, "cannot read object.json: "]);
    with("[]", &["object.json: a composite contour needs at least one piece"]);
    with("[\n{]", &["object.json:2: "]);
    with("[{\"shape\": \"lime\"}]", &["object.json:1: the shape is `lime`", "`polygon`"]);
    let arc = |radius: &str| {
        format!(
            "[{{\"shape\": \"arc\", \"center\": [0, 0], \"radius\": {radius}, \"from_angle\": 0, \"to_angle\": 9}}]"
        )
    };
    with(&arc("0"), &["object.json: shape 1, radius: the arc's radius is 0, expected a positive number"]);
    let tie = "[{\"shape\": \"polygon\", \"points\": [[0, 0], [1, 1], [1, 0], [0, 1]]}]";
    with(tie, &["object.json: piece 1 crosses piece 3 at (0.5, 0.5)"]);
    let both = square("file = \"object.json\"");
    says(&both, &["scene.toml:7:8: object[1].file: ", "given beside pieces, expected either"]);
}
