//! What the algorithms run on.

/// The instruction set the core's algorithms use in this program on this machine.
pub fn instruction_set() -> String {
    if let Some(chosen) = gyroflex::dispatch::chosen_instructions() {
        return format!("{chosen}, chosen at run time");
    }
    let compiled = if cfg!(target_feature = "avx512f") {
        "AVX-512"
    } else if cfg!(target_feature = "fma") {
        "AVX2 and FMA"
    } else {
        std::env::consts::ARCH
    };
    format!("{compiled}, as compiled")
}
