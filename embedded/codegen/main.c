/* Runs generated dynamics of an arm on a Cortex-M7 without a library: results as bits, and instructions per call.
   `points.h` holds the states; what is printed goes to the debugger that the emulator plays. */

#include "arm.h"
#include "chip.h"
#include "points.h"

/* The core's own timer counts down at 25 MHz, 40 ns a tick. With `-icount shift=8` an instruction takes 256 ns of it: so many
   ticks that the difference of two readings, each cut off to a whole tick, rounds to the exact count. */
#define SYST_CSR (*(volatile uint32_t *)0xE000E010u)
#define SYST_RVR (*(volatile uint32_t *)0xE000E014u)
#define SYST_CVR (*(volatile uint32_t *)0xE000E018u)
#define RELOAD 0x00ffffffu
#define NS_PER_TICK 40u
#define NS_PER_INSTRUCTION 256u

static void print_bits(REAL x)
{
    union {
        REAL number;
        unsigned char bytes[sizeof(REAL)];
    } u = {x};
    char text[2 * sizeof(REAL) + 2], *at = text;
    *at++ = ' ';
    for (size_t i = sizeof(REAL); i-- > 0;) {
        *at++ = "0123456789abcdef"[u.bytes[i] >> 4];
        *at++ = "0123456789abcdef"[u.bytes[i] & 15];
    }
    *at = 0;
    print(text);
}

static void print_number(uint32_t n)
{
    char text[12], *at = text + sizeof text - 1;
    *at = 0;
    do
        *--at = (char)('0' + n % 10);
    while (n /= 10);
    *--at = ' ';
    print(at);
}

static void print_point(const char *name, uint32_t ticks, const REAL *out, int n)
{
    print(name);
    print_number(((ticks & RELOAD) * NS_PER_TICK + NS_PER_INSTRUCTION / 2) / NS_PER_INSTRUCTION);
    for (int i = 0; i < n; i++)
        print_bits(out[i]);
    print("\n");
}

int run(void)
{
    static REAL out[3 * N];
    SYST_RVR = RELOAD;
    SYST_CVR = 0;
    SYST_CSR = 5; /* on, from the core's clock, without interrupts */
    for (int k = 0; k < POINTS; k++) {
        /* q, qd, theta, thetad, then tau or qdd and thetadd. */
        const REAL *in = points[k];
        uint32_t start = SYST_CVR;
        arm_forward_dynamics(in, in + N, in + 2 * N, in + 3 * N, in + 4 * N, out, out + N, out + 2 * N);
        print_point("forward", start - SYST_CVR, out, 3 * N);
        start = SYST_CVR;
        arm_inverse_dynamics(in, in + N, in + 2 * N, in + 3 * N, in + 5 * N, in + 6 * N, out, out + N);
        print_point("inverse", start - SYST_CVR, out, 2 * N);
    }
    return 1;
}
