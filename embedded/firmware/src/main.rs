//! Runs the laws, counts instructions, and moves an arm at 1 kHz. Ends with success if all of it held.
#![no_std]
#![no_main]

mod board;
mod count;
mod motion;
mod report;

use board::Board;
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use report::Verdict;

/// Makes the states; printed, so that a failure can be repeated.
const SEED: u32 = 0x6779_726f;

#[entry]
fn main() -> ! {
    let Some(board) = Board::take() else { board::end(false) };
    hprintln!("seed {:#x}", SEED);
    let mut verdict = Verdict::new();
    report::motion(&board, &mut verdict);
    hprintln!("loop stack {} bytes, the simulated arm included", board::stack_used());
    report::counts(&board, SEED, &mut verdict);
    report::laws(SEED, &mut verdict);
    report::elastic_law(SEED, &mut verdict);
    report::held_law(SEED, &mut verdict);
    hprintln!("{}", if verdict.held() { "held" } else { "FAILED" });
    board::end(verdict.held())
}
