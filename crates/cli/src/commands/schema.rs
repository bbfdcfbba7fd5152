//! `gyroflex schema`.

use crate::args::{Schema, SchemaName};
use crate::failure::{Failure, print};
use gyroflex_sim::error::Error;

pub fn run(args: &Schema) -> Result<(), Failure> {
    let schema = match args.file {
        SchemaName::Robot => gyroflex_sim::load::robot_schema(),
        SchemaName::Scenario => gyroflex_sim::scenario::scenario_schema(),
    };
    print(&serde_json::to_string_pretty(&schema).map_err(Error::from)?)
}
