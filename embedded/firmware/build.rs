//! Hands the memory map to the linker, and asks for the exported robot.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy("memory.x", out.join("memory.x")).expect("memory.x is beside this file");
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rerun-if-changed=memory.x");
    for model in ["complete", "rigid"] {
        let file = format!("src/arm/{model}.rs");
        println!("cargo:rerun-if-changed={file}");
        assert!(
            Path::new(&file).exists(),
            "{file} is missing. `embedded/run` makes it with\n  \
             gyroflex export --rust robots/iiwa14/robot.yaml --model {model} --scalar f32 -o embedded/firmware/{file}"
        );
    }
}
