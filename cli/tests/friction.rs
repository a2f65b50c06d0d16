//! Scenes with friction that were wrong, stopped or took minutes.

use crate::common::{edited, refused_beside, vibrissa};
use rod_files::Scene;
use std::collections::BTreeSet;
use vibrissa::contact::{EventKind, Outcome};
use vibrissa::{Event, State};

/// The sweep of a scene, in at most so many steps.
fn swept(scene: &str) -> Outcome {
    let scene = Scene::parse("scene.toml".as_ref(), scene).unwrap();
    scene.sweep().unwrap().with_most_steps(20_000).run()
}

/// All states of a sweep, those at events with it.
fn all(outcome: &Outcome) -> impl Iterator<Item = &State> {
    let at_events = outcome.events.iter().flat_map(|event| [&event.before, &event.after]);
    outcome.states.iter().chain(at_events)
}

fn kinds(outcome: &Outcome) -> Vec<EventKind> {
    outcome.events.iter().map(|event| event.kind).collect()
}

/// A wire, an object of one piece, and a law of friction.
fn scene(friction: &str, piece: &str, sweep: &str) -> String {
    let wire = "length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n";
    scene_of(wire, friction, &format!("[[object.piece]]\n{piece}\n"), sweep)
}

/// A rod, an object, and a law of friction.
fn scene_of(rod: &str, friction: &str, object: &str, sweep: &str) -> String {
    format!("[rod]\n{rod}[contact]\nfriction = {friction}\n[[object]]\n{object}[sweep]\n{sweep}")
}

const PARABOLA: &str = "shape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 50.0";
const DISC: &str = "shape = \"arc\"\ncenter = [0.0, 0.01]\nradius = 0.01\nfrom_angle = -90\nto_angle = 270";
const STATIC: &str = "{ at_rest = 0.3, slipping = 0.2 }";

/// What slips goes on to slip where a leg ends, or a contact changes, although friction at rest could hold it.
#[test]
fn friction_at_rest_does_not_stop_what_slips() {
    let one = "from = [0.08, -0.04]\nto = [-0.02, -0.04]\nangle = 90.0\nstep = 1e-3\n";
    let two =
        "from = [0.08, -0.04]\nto = [0.02, -0.04]\nangle = 90.0\nstep = 1e-3\n[[sweep.leg]]\nto = [-0.02, -0.04]\n";
    let [one, two] = [one, two].map(|sweep| swept(&scene(STATIC, PARABOLA, sweep)));
    assert!(one.stop.is_none() && two.stop.is_none(), "{:?} {:?}", one.stop, two.stop);
    assert_eq!(kinds(&one), kinds(&two));
    for (one, two) in one.states.iter().zip(&two.states) {
        assert!((one.reactions.f0x - two.reactions.f0x).abs() < 1e-10 && (one.pose.x - two.pose.x).abs() < 1e-12);
    }

    let past = "from = [0.08, -0.04]\nto = [-0.09, -0.04]\nangle = 90.0\nstep = 1e-3\n";
    let [law, kinetic] = [STATIC, "0.2"].map(|friction| swept(&scene(friction, DISC, past)));
    assert!(law.stop.is_none(), "{:?}", law.stop);
    // it never comes to rest
    let poses = |outcome: &Outcome| outcome.events.iter().map(|event| (event.kind, event.pose().x)).collect::<Vec<_>>();
    assert_eq!(poses(&law), poses(&kinetic));

    // past two parabolas, with two contacts and their transitions
    let law = swept(
        &edited("to = [0.03, -0.04]", "to = [-0.09, -0.04]")
            .replace("[sweep]", &format!("[contact]\nfriction = {STATIC}\n[sweep]")),
    );
    assert!(law.stop.is_none(), "{:?}", law.stop);
    let phases: Vec<_> = law.events.iter().map(|event: &Event| event.to().to_string()).collect();
    assert_eq!(phases, ["A", "B", "BB", "BA", "B", "A", "free"]);
}

/// A tip that sticks has no rate at all: its piece has no border ahead.
#[test]
fn a_tip_that_sticks_takes_long_steps() {
    let outcome = swept(&scene_of(
        "length = 0.1\ndiameter = 0.0005\nyoungs_modulus = 205348073774.88702\ntip_diameter = 0.00025\n\
         natural_curvature = -6.066333112443578\n",
        "0.5",
        "mirror = true\nangle = -151.73831745877726\n\
         [[object.piece]]\nshape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 24.716016243408518\n",
        "from = [-0.09371526713526734, -0.10022430504016558]\nto = [0.13529122761503473, 0.022885505138308355]\n\
         angle = -241.73831745877726\nstep = 0.0005\n",
    ));
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    assert!(kinds(&outcome).starts_with(&[EventKind::FirstContact, EventKind::Stick, EventKind::Slip]));
}

/// Friction lets the force in a notch lean further than the walls do: from there on steps are no shorter.
#[test]
fn a_tip_that_leans_in_a_notch_takes_long_steps() {
    let scene = r#"
[rod]
length = 0.1
diameter = 0.0005
youngs_modulus = 205348073774.88702
tip_diameter = 0.00032114067386396954
[contact]
friction = 0.2
[[object]]
mirror = true
angle = 61.02048860005149
[[object.piece]]
shape = "parabola"
vertex = [-0.012577887813760028, 0.0010920971553748395]
coefficient = 25.415644840838194
[[object.piece]]
shape = "parabola"
vertex = [0.012577887813760028, 0.0]
coefficient = 27.903494971471893
[sweep]
from = [-0.0034833684895889463, 0.15053581657107923]
to = [-0.07794955891234327, 0.016081885906827728]
angle = -15.831481430221487
angle_to = -15.831481430221487
step = 0.002
step_angle = 0.5
[[sweep.leg]]
to = [-0.07691081707646258, 0.017957407159985367]
angle_to = -15.831481430221487
step = 0.0005244337903412473
[[sweep.leg]]
to = [-0.08079087246249288, 0.014021978413230336]
angle_to = -15.831481430221487
step = 0.0008390940645459958
[[sweep.leg]]
to = [-0.07615697479329188, 0.019650607875103653]
angle_to = -15.831481430221487
step = 0.0004661633691922199
[[sweep.leg]]
to = [-0.12945254452552257, -0.07691036758866432]
angle_to = -15.831481430221487
"#;
    let outcome = swept(scene);
    assert!(outcome.stop.is_none() && outcome.events.len() > 10, "{:?}", outcome.stop);
}

/// A tip that is let go sideways leaves the cone on one side before its force vanishes.
#[test]
fn what_sticks_slips_before_it_is_released() {
    let scene = r#"
[rod]
length = 0.1
diameter = 0.0005
youngs_modulus = 205348073774.88702
tip_diameter = 0.00025
natural_curvature = -4.494451498835907
[contact]
friction = { at_rest = 1.8911813424162935, slipping = 1.2 }
[[object]]
mirror = true
angle = -125.42036140461857
[[object.piece]]
shape = "spline"
points = [[-0.06999999999999999, 0.0036365807086101718], [-0.04666666666666667, 0.005956566848864239], [-0.023333333333333334, 0.013170807720966807], [0.0, 0.001268380530835026], [0.02333333333333333, 0.015075025044491054], [0.04666666666666666, 0.010558906952635758], [0.06999999999999999, 0.004909023827976102]]
end = "natural"
[sweep]
from = [0.07967534955691923, -0.09501999254834682]
to = [0.06251322908842576, 0.001627753412115857]
angle = -235.15037029951299
angle_to = -235.15037029951299
step = 0.0005
step_angle = 0.5
[[sweep.leg]]
to = [0.09849521555668057, -0.06855778921028007]
angle_to = -235.15037029951299
"#;
    let outcome = swept(scene);
    assert!(outcome.stop.is_none() && outcome.events.len() > 3, "{:?}", outcome.stop);
    for contact in all(&outcome).flat_map(|state| &state.contacts) {
        let friction = contact.friction.unwrap();
        assert!(friction.force.abs() <= 1.8911813424162935 * contact.force + 1e-9, "{contact:?}");
    }
}

/// Where the tip is at right angles to the contour its sense changes, and g does not.
#[test]
fn the_slip_of_a_tip_does_not_jump() {
    let outcome = swept(&scene_of(
        "length = 0.1\nbending_stiffness = 0.00063\nnatural_curvature = -7.636413682366336\n",
        "1.6",
        "angle = 178.08465691454273\n\
         [[object.piece]]\nshape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 3.206528232238931\n",
        "from = [0.13270247445074235, 0.07863890588619228]\nto = [-0.03305407566115461, 0.08418205372983202]\n\
         angle = 268.08465691454273\nstep = 0.0005\n",
    ));
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    let tips = outcome.states.windows(2).filter_map(|pair| {
        let [one, two] = [&pair[0], &pair[1]].map(|state| state.contacts.last());
        let (one, two) = (one?, two?);
        let way = (two.x - one.x).hypot(two.y - one.y) + (two.s - one.s).abs();
        Some((two.friction?.slip - one.friction?.slip, way))
    });
    let tips: Vec<_> = tips.collect();
    assert!(tips.len() > 20);
    for (slip, way) in tips {
        assert!(slip.abs() < 1.1 * way + 1e-9, "{slip} {way}");
    }
}

/// A snap never leads back to the equilibrium that has ended.
#[test]
fn no_snap_leads_back_to_where_it_began() {
    let outcome = swept(&scene_of(
        "length = 0.1\nbending_stiffness = 0.00063\n\
         natural_curvature = [[0.0, 1.9968723187500514], [0.1, 2.5902969812948196]]\n",
        "0.05",
        "angle = -172.67257902493057\n\
         [[object.piece]]\nshape = \"parabola\"\nvertex = [-0.013294725845142416, 0.00031447432285598134]\n\
         coefficient = 75.98531981720159\n\
         [[object.piece]]\nshape = \"parabola\"\nvertex = [0.013294725845142416, 0.0]\ncoefficient = 88.63730473772638\n",
        "from = [0.11955849629756161, 0.08952437370840646]\nto = [-0.1367588331092958, 0.044237301431171126]\n\
         angle = -70.39730174437638\nangle_to = -80.48646433163321\nstep = 0.002\n",
    ));
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    for event in outcome.events.iter().filter(|event| event.kind == EventKind::Snap) {
        assert!((event.before.energy - event.after.energy).abs() > 1e-9 * event.before.energy, "{event:?}");
    }
}

/// A rod that leaves a disc at the pose where it has touched it is released, with friction as without.
#[test]
fn a_rod_without_force_is_released() {
    let there_and_back =
        "from = [0.03, -0.07]\nto = [0.005, -0.07]\nangle = 90.0\nstep = 1e-3\n[[sweep.leg]]\nto = [0.03, -0.07]\n";
    for friction in ["0", "0.1"] {
        let outcome = swept(&scene(friction, DISC, there_and_back));
        assert_eq!(kinds(&outcome).last(), Some(&EventKind::Release), "{friction}");
    }
}

/// A clamp that turns back: an event tells that contacts come to rest, once.
#[test]
fn a_turn_of_the_path_is_an_event() {
    let there_and_back =
        "from = [0.08, -0.04]\nto = [0.0, -0.04]\nangle = 90.0\nstep = 1e-3\n[[sweep.leg]]\nto = [0.03, -0.04]\n";
    let outcome = swept(&scene("0.3", PARABOLA, there_and_back));
    let at_turn: Vec<_> = outcome.events.iter().filter(|event| event.pose().x == 0.0).collect();
    let [turn] = at_turn[..] else { panic!("{at_turn:?}") };
    assert_eq!((turn.kind, turn.leg()), (EventKind::Stick, 1));
    let modes = [&turn.before, &turn.after].map(|state| state.contacts[0].friction.unwrap().mode.to_string());
    assert_eq!(modes, ["slip-", "stick"]);
    let phases: BTreeSet<_> = [turn.from(), turn.to()].map(|phase| phase.to_string()).into();
    assert_eq!(phases.len(), 1);
    // without friction nothing happens there
    let smooth = swept(&scene("0", PARABOLA, there_and_back));
    assert!(smooth.events.iter().all(|event| event.pose().x != 0.0));
}

#[test]
fn a_coefficient_told_wrong_has_its_place_and_what_was_expected() {
    for (friction, parts) in [
        ("-0.1", ["contact.friction: ", "friction is -0.1, expected a finite coefficient, 0 or more"]),
        ("{ at_rest = inf, slipping = 0.3 }", ["contact.friction: ", "friction is inf, expected a finite coefficient"]),
        ("{ at_rest = 0.2, slipping = 0.3 }", ["contact.friction: ", "expected 0 < slipping <= at_rest"]),
        (
            "{ at_rest = 0.2, slipping = 0 }",
            ["contact.friction: ", "friction is 0 slipping and 0.2 at rest, expected 0 <"],
        ),
        ("{ at_rest = 0.4, slipping = \"0.3\" }", ["contact.friction: ", "`slipping` is string, expected a number"]),
        ("{ at_rest = 0.4 }", ["contact.friction: ", "`slipping` is missing, expected a number"]),
        ("[0.3, 0.1]", ["contact.friction: ", "a list, expected a coefficient, such as 0.3"]),
    ] {
        said(&format!("[contact]\nfriction = {friction}\n"), &parts);
    }
    said("[clamp]\nroller = 20\n", &["clamp.roller: ", "is it in mm?"]);
    said("[contact]\nmu = 0.3\n", &["did you mean friction"]);
}

/// What is said of the scene with another table.
fn said(table: &str, parts: &[&str]) {
    let message = refused_beside(&edited("[sweep]", &format!("{table}[sweep]")), &[]);
    assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} are not in: {message}");
}

/// Neither the printed events nor the drawing told which contact slips or sticks.
#[test]
fn modes_are_printed_and_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let scene = include_str!("../../scenes/there_and_back.toml").replace("to = [-0.02, -0.04]", "to = [-0.053, -0.04]");
    let smooth = scene.replace("friction = 0.3", "friction = 0");
    let [(report, drawing), (of_smooth, drawing_of_smooth)] = [scene, smooth].map(|scene| {
        std::fs::write(directory.path().join("scene.toml"), scene).unwrap();
        let output = vibrissa(directory.path(), &["sweep", "scene.toml", "--out", "out"]);
        assert!(output.status.success(), "{output:?}");
        let drawing = std::fs::read_to_string(directory.path().join("out/sweep.svg")).unwrap();
        (String::from_utf8(output.stdout).unwrap(), drawing)
    });
    // where the clamp turns the tip sticks, while the first contact slips on
    let turn: Vec<&str> = report.lines().filter(|line| line.trim_start().starts_with("stick ")).collect();
    assert!(turn.len() == 1 && turn[0].ends_with("slip-, slip- -> slip-, stick"), "{report}");
    let ends = |end: &str| report.lines().filter(|line| line.ends_with(end)).count();
    assert_eq!((ends("slip-, stick -> stick, slip+"), ends("stick, slip+ -> slip+, slip+")), (1, 1), "{report}");
    assert!(report.contains("contacts, clamp to tip") && !of_smooth.contains("slip"), "{of_smooth}");
    // a row for each contact, and a pale line along both intervals with a contact that sticks in each of three plots
    let wide = |drawing: &str, width: u32| drawing.matches(&format!("stroke-width=\"{width}\"")).count();
    let names = ["slip+", "slip-", "stick"];
    assert!(names.iter().all(|name| drawing.contains(&format!(">{name}<"))), "{drawing}");
    assert_eq!(wide(&drawing, 14), 2 * 3);
    assert!(names.iter().all(|name| !drawing_of_smooth.contains(name)) && wide(&drawing_of_smooth, 14) == 0);
}

/// A contact that bears nothing yet holds nothing back: the rod is as stable as without it.
#[test]
fn a_touch_leaves_a_slipping_rod_stable() {
    for coefficient in ["0.3", "0.5", "{ at_rest = 0.5, slipping = 0.3 }"] {
        let scene = format!("{}\n[contact]\nfriction = {coefficient}\n", include_str!("../../scenes/gears.toml"));
        let events = swept(&scene).events;
        assert!(events.len() > 10 && events.iter().all(|event| event.after.certificate.stable), "{coefficient}");
    }
}

/// What a jump loses can be read off the files, and what is lost on the whole way.
#[test]
fn files_say_what_is_lost() {
    let dir = tempfile::tempdir().unwrap();
    let scene = format!("{}\n[contact]\nfriction = 0.1\n", include_str!("../../scenes/whisking.toml"));
    std::fs::write(dir.path().join("whisking.toml"), scene).unwrap();
    assert!(vibrissa(dir.path(), &["sweep", "whisking.toml", "--out", "out"]).status.success());
    let read = |name: &str| std::fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    let events: Vec<serde_json::Value> =
        read("events.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let lost = |event: &serde_json::Value| number(&event["energy"]) - number(&event["after"]["energy"]);
    let jumps: f64 = events.iter().filter(|event| event["kind"] == "snap-off").map(lost).sum();
    let whole: serde_json::Value = serde_json::from_str(&read("sweep.json")).unwrap();
    let all = number(&whole["dissipated"]);
    assert!(jumps > 0.0 && all > jumps, "{jumps} of {all}");
    assert!((all - number(&events.last().unwrap()["dissipated"])).abs() <= 1e-6 * all);
}
