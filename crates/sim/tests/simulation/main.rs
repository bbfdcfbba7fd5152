//! Laws of scenarios and simulations.

mod arm;
mod controllers;
mod equilibria;
mod integration;
mod logs;
mod plant;
mod references;
mod refusals;
mod robots;
mod samples;
mod scenario_files;
mod trajectories;
