//! Where links are.

use super::Options;
use super::bending::Storage;
use super::tracing::{Tracing, traced};
use crate::function::Function;
use crate::robot::Robot;
use crate::sym::Sym;
use gyroflex::dynamics::{FlexiblePlacements, flexible_placements};
use gyroflex::spatial::Transform;

/// Poses of all link frames in the world, and of the stations of links that bend.
pub(super) fn placements(robot: &Robot, options: &Options) -> Function {
    traced("placements", "Poses of the link frames in the world.", |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options);
        let mut links = vec![Transform::identity(); records.view().bodies().len()];
        let Some(model) = records.flexible() else {
            gyroflex::dynamics::placements(&records.view(), &q, &mut links).expect("lengths are the model's");
            return poses(t, &links, ["positions", "rotations"], "link");
        };
        let mut stations = vec![Transform::identity(); model.stations().len()];
        let out = FlexiblePlacements { links: &mut links, stations: &mut stations };
        flexible_placements(&model, &q, Storage::of(&model).lend(), out).expect("lengths are the model's");
        poses(t, &links, ["positions", "rotations"], "link");
        poses(t, &stations, ["station_positions", "station_rotations"], "station of a link that bends");
    })
}

fn poses(t: &mut Tracing, poses: &[Transform<Sym>], [positions, rotations]: [&str; 2], of: &str) {
    let entries: Vec<Sym> = poses.iter().flat_map(|pose| pose.pos.to_array()).collect();
    t.matrix(positions, &entries, 3, &format!("origin of each {of} in the world, a row each [m]"));
    let rows = |pose: &Transform<Sym>| pose.rotation().rows.map(|row| row.to_array());
    let entries: Vec<Sym> = poses.iter().flat_map(rows).flatten().collect();
    t.matrix(
        rotations,
        &entries,
        9,
        &format!("rotation matrix of each {of} by rows, a row each: its coordinates to the world's"),
    );
}
