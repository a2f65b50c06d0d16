//! On what was measured, and when.
#![allow(dead_code, reason = "each bench takes what it needs")]

use std::process::Command;

/// Packages whose versions matter.
const PACKAGES: [&str; 3] = ["argmin", "nalgebra", "ode_solvers"];

/// One line: date, processor, compiler, versions. The date is that of `DATE` in the environment, if it is there.
pub fn line() -> String {
    let date = std::env::var("DATE").unwrap_or_else(|_| said_by("date", &["-u", "+%F"]));
    let compiler = compiler();
    let versions: Vec<String> = PACKAGES.into_iter().map(|package| format!("{package} {}", version(package))).collect();
    let ours = env!("CARGO_PKG_VERSION");
    format!("{date}; {}, one core; {compiler}; vibrissa {ours}, {}", processor(), versions.join(", "))
}

/// The compiler and its version.
pub fn compiler() -> String {
    let said = said_by(&std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned()), &["--version"]);
    said.split(" (").next().unwrap_or_default().to_owned()
}

fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    output.map_or("unknown".to_owned(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or("unknown processor".to_owned(), |(_, model)| model.trim().to_owned())
}

/// Of a package in the lock file.
fn version(package: &str) -> String {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).unwrap_or_default();
    let name = format!("name = \"{package}\"");
    let next = text.lines().skip_while(|line| *line != name).nth(1).unwrap_or_default();
    next.trim_start_matches("version = ").trim_matches('"').to_owned()
}
