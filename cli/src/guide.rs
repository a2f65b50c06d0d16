//! What the help says: examples, and what to do next.

pub const STATUS: &str = "\
First steps:
  vibrissa init                  write a scene with comments, scene.toml
  vibrissa sweep scene.toml      sweep the rod, results and a figure into out/scene
Then open out/scene/sweep.svg in a browser, change the scene and sweep again. `vibrissa help COMMAND` explains a command.

Exit status: 0 done, 1 an error, 2 a sweep that stopped early or does not give the paper's phases, a recording \
that does not fit its rod or its units, recordings that contradict each other, a sensor that does not suit the rod or fell silent, wrong options, 130 interrupted with Ctrl-C (143 \
with SIGTERM). Interrupted, sweep, simulate and paper write what they have and mark it as incomplete, reconstruct, calibrate, \
budget, contour, plan and reach write nothing; live and fake-sensor end as usual. A second time ends any of them at once.

No command replaces a link, a device or one of its own inputs.";

pub const INIT: &str = "\
Examples:
  vibrissa init bump.toml
  vibrissa init --whisking whisking.toml
  vibrissa init --whisker C2 whisker.toml

Next: `vibrissa sweep bump.toml`. A file that exists is never overwritten.";

pub const SWEEP: &str = "\
Example:
  vibrissa sweep scene.toml --out results

Files: states.jsonl and states.csv (one line a pose), contacts.csv (one line a contact), events.jsonl (transitions), sweep.json
(whether it is complete), sweep.svg.
Next: open sweep.svg in a browser. `vibrissa simulate` gives the recording of a sensor along the same scene.";

pub const ELASTICA: &str = "\
Example of a file, column.toml, a column 1.2 times over its Euler load:
  branches = \"all\"
  [rod]
  length = 0.1
  bending_stiffness = 6.3e-4
  [clamp]
  angle = 90.0
  [tip]
  force = [0.0, -0.1865]

  vibrissa elastica column.toml

Next: open elastica.svg of the results in a browser; docs/elastica.md has loads along the rod, and tips that are pinned, clamped or guided.";

pub const CONTOUR: &str = "\
Examples:
  vibrissa contour scene.toml
  vibrissa contour scene.toml --object 0 --file - > object.csv

Next: open contour.svg, see whether the outline is what you mean, then `vibrissa sweep` the scene.";

pub const PLAN: &str = "\
Example:
  vibrissa reconstruct recording.csv --rod scene.toml --out result
  vibrissa plan result --rod scene.toml --noise noise.toml --stress 8e8 --out next
  vibrissa plan result --rod scene.toml --paths scans.toml --stress 8e8 --out next
  vibrissa plan --box=-0.03,0.0,0.03,0.05 --rod scene.toml --stress 8e8 --out first

Next: open plan.svg in a browser, make the first scan of plan.json, and reconstruct both recordings together.";

pub const REACH: &str = "\
Examples:
  vibrissa reach scene.toml
  vibrissa reach scene.toml --distances 0.02:0.08:25 --angles 0:350:36

Next: open reach.svg in a browser. A part that is never touched needs another rod or a scan that is not straight.";

pub const SHAPES: &str = "\
Example:
  vibrissa shapes

Next: put a shape into an [[object.piece]] of a scene, and look at it with `vibrissa contour`.";

pub const SIMULATE: &str = "\
Examples:
  vibrissa simulate scene.toml --file recording.csv
  vibrissa simulate scene.toml --noise noise.toml --seed 1 --file - > recording.csv

Next: `vibrissa reconstruct recording.csv --rod scene.toml --truth scene.toml`.";

pub const INSPECT: &str = "\
Examples:
  vibrissa inspect scan.csv --rod rod.toml
  vibrissa inspect force.xlsx stage.csv --rod rod.toml --write-setup sensor.toml
  vibrissa inspect scan.csv --unit Fx=mN --unit Fy=mN --unit Mz='N mm'

Next: run the command that it prints. docs/recordings.md lists the formats, columns and units.";

pub const RECONSTRUCT: &str = "\
Examples:
  vibrissa reconstruct recording.csv --rod rod.toml
  vibrissa reconstruct near.csv far.csv --rod rod.toml --out object
  vibrissa reconstruct volts.tdms --rod scene.toml --setup sensor.toml --stage constant:1e-3

Next: open contour.svg, phases.svg and residuals.svg of the results in a browser; docs/output-files.md explains every field of the others.";

pub const FORCES: &str = "\
Examples:
  vibrissa forces frames.csv --rod whisker.toml
  vibrissa forces pixels.csv --rod whisker.toml --scale 4.2e-5 --image --rest free.csv
  vibrissa forces torque.csv --rod rod.toml     # a recording with some of its columns

Next: open frames.svg and forces.svg of the results in a browser; docs/forces-from-shapes.md explains the verdicts.";

pub const CALIBRATE: &str = "\
Examples:
  vibrissa calibrate first.csv second.csv --rod rod.toml --file calibrated.toml
  vibrissa calibrate first.csv --rod rod.toml --free stiffness,angle --file calibrated.toml

Next: `vibrissa reconstruct third.csv --rod calibrated.toml`; docs/laboratory.md lists the errors that a scan determines.";

pub const BUDGET: &str = "\
Examples:
  vibrissa budget scene.toml --rate 100
  vibrissa budget scene.toml --setup sensor.toml --noise noise.toml --runs 100
  vibrissa budget rods.toml --rods --noise noise.toml --sigma 1e-5

Next: state your own errors in the table [errors] of sensor.toml (docs/laboratory.md), and see which one matters.";

pub const LIVE: &str = "\
Example, without a sensor, in two terminals:
  vibrissa fake-sensor scene.toml --protocol rdt --speed 0.01
  vibrissa live --sensor rdt://127.0.0.1 --rod scene.toml --stage constant:0.01

Next: `vibrissa reconstruct out/live/recording.csv --rod scene.toml` resolves two contacts, which needs the whole scan.";

pub const FAKE_SENSOR: &str = "\
Example:
  vibrissa fake-sensor scene.toml --protocol rdt --speed 0.01

Next: the command prints its address; `vibrissa live --sensor ADDRESS` in another terminal.";

pub const STUDY: &str = "\
Example of a study, distance.toml, beside scene.toml:
  scene = \"scene.toml\"
  [[parameter]]
  name = \"distance\"
  from = 0.1
  to = 0.9
  count = 9
  set = [{ field = \"sweep.from[2]\", scale = -0.1 }, { field = \"sweep.to[2]\", scale = -0.1 }]

  vibrissa study distance.toml

Next: docs/studies.md explains every column of rows.csv.";

pub const PAPER: &str = "\
Example:
  vibrissa paper --out paper

Next: open phase_cycles.svg and notches.svg of the results in a browser.";

pub const COMPLETIONS: &str = "\
Examples:
  vibrissa completions bash > ~/.local/share/bash-completion/completions/vibrissa
  vibrissa completions zsh > ~/.zfunc/_vibrissa

Next: start a new shell.";

pub const MAN: &str = "\
Examples:
  vibrissa man > vibrissa.1
  vibrissa man sweep > vibrissa-sweep.1

Next: `man ./vibrissa.1`.";
