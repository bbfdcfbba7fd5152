//! The Rust libraries dynibo and rapier3d in the comparison. Usage: `gyroflex-peers FOLDER ROBOT… [--count ROW CALLS]`

mod dynibo_fixed;
mod dynibo_floating;
#[path = "../../../src/peers/mod.rs"]
#[allow(dead_code, unused_imports)] // shared with gyroflex's program, which has other needs
mod peers;
mod rapier;

use peers::{Tree, Worker};

fn main() {
    let mut worker = Worker::from_args();
    for name in worker.robots.clone() {
        let tree = Tree::read(&worker.folder, &name);
        if tree.floating() {
            dynibo_floating::add(&mut worker, tree);
        } else {
            dynibo_fixed::add(&mut worker, tree.clone());
            rapier::add(&mut worker, tree);
        }
    }
    worker.serve();
}
