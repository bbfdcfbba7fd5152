//! The `gyroflex` command.
fn main() {}
