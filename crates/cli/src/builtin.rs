//! The robot and scenario compiled into the program.

use gyroflex_sim::load::Embedded;

/// Files of the built-in scenario, the same as in `robots/puma560`.
pub const FILES: Embedded = Embedded(&[
    ("puma560/puma560.urdf", include_str!("../../../robots/puma560/puma560.urdf")),
    ("puma560/robot.yaml", include_str!("../../../robots/puma560/robot.yaml")),
    ("puma560/track.yaml", include_str!("../../../robots/puma560/track.yaml")),
]);

/// The scenario among them.
pub const SCENARIO: &str = "puma560/track.yaml";

/// The name of its log.
pub const LOG: &str = "puma560.mcap";
