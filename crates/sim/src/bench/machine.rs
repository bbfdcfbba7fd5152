//! What the algorithms run on.

/// The instruction set the core's algorithms use in this program on this machine.
pub fn instruction_set() -> String {
    let compiled = if cfg!(target_feature = "avx512f") {
        "AVX-512"
    } else if cfg!(target_feature = "fma") {
        "AVX2 and FMA"
    } else if cfg!(target_arch = "aarch64") {
        "NEON"
    } else {
        return at_run_time().to_owned();
    };
    format!("{compiled}, as compiled")
}

#[cfg(target_arch = "x86_64")]
fn at_run_time() -> &'static str {
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        "AVX2 and FMA, chosen at run time"
    } else {
        "SSE2: this processor has no AVX2 with FMA"
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn at_run_time() -> &'static str {
    std::env::consts::ARCH
}
