//! The clock, the stack, and the way out.

use core::sync::atomic::{Ordering, compiler_fence};
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::{debug, hprintln};

/// The counter wraps at 24 bits.
const RELOAD: u32 = 0x00ff_ffff;
/// The boards' clock: 25 MHz. QEMU with `-icount shift=8` lets an instruction take 256 ns of it: so many ticks that a
/// difference of two readings, each cut off to a whole tick, rounds to the exact count.
const NS_PER_TICK: u32 = 40;
const NS_PER_INSTRUCTION: u32 = 256;

/// The core's own timer, counting down.
pub struct Board(());

impl Board {
    /// Starts the timer; `None` if it was taken before.
    pub fn take() -> Option<Self> {
        let mut syst = Peripherals::take()?.SYST;
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(RELOAD);
        syst.clear_current();
        syst.enable_counter();
        Some(Self(()))
    }

    /// Instructions of one call of `f`, reading the timer included. At most two million.
    #[inline(always)]
    pub fn instructions(&self, f: impl FnOnce()) -> u32 {
        let start = now();
        f();
        let ticks = start.wrapping_sub(now()) & RELOAD;
        (ticks * NS_PER_TICK + NS_PER_INSTRUCTION / 2) / NS_PER_INSTRUCTION
    }
}

#[inline(always)]
fn now() -> u32 {
    compiler_fence(Ordering::SeqCst);
    let ticks = SYST::get_current();
    compiler_fence(Ordering::SeqCst);
    ticks
}

/// Ends the emulation; its exit status says whether all held.
pub fn end(held: bool) -> ! {
    debug::exit(if held { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}

/// Most bytes the stack has held: what of it no longer has the pattern the start-up code painted it with.
pub fn stack_used() -> usize {
    const PAINT: u32 = 0xcccc_cccc;
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    let (mut low, high) = (&raw const _stack_end, &raw const _stack_start);
    // SAFETY: the linker script puts both at the ends of the stack's memory, which is readable; nothing else writes it.
    unsafe {
        while low < high && low.read_volatile() == PAINT {
            low = low.add(1);
        }
        high.offset_from(low) as usize * size_of::<u32>()
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo) -> ! {
    hprintln!("{}", info);
    end(false)
}

/// Ends the run with a message, for instance when the stack has outgrown its memory.
// SAFETY: an exception handler; it reads the frame it is given and does not return.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    hprintln!("hard fault at {:#010x}", frame.pc());
    end(false)
}
