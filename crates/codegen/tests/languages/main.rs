//! Laws of what is written: compiled and run, it computes what the library does.
//!
//! Files of random robots go to a folder of their own under the temporary ones, are compiled, and are fed with states; what comes
//! out is held against the core for forward and inverse dynamics and the inertia matrix, and for everything else against the
//! graph, of which the laws in `quantities` say that it is the library.

mod c;
mod cases;
mod elementary;
mod head;
mod json;
mod python;
mod robots;
mod rust;
mod toolchain;
