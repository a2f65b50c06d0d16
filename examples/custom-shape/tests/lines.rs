//! The promise that a shape is little work: at most 25 lines.

#[test]
fn the_shape_has_at_most_25_lines_of_code() {
    let source = include_str!("../src/trochoid.rs");
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
    let count = source.lines().filter(is_code).count();
    assert!(count <= 25, "{count} lines");
}
