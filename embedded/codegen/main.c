/* Runs generated dynamics of an arm on a Cortex-M7 without a library: results as bits, and instructions per call.
   `points.h` holds the states; what is printed goes to the debugger that the emulator plays. */

#include "arm.h"
#include "points.h"

#include <stddef.h>
#include <stdint.h>

/* The core's own timer counts down at 25 MHz, 40 ns a tick. With `-icount shift=8` an instruction takes 256 ns of it: so many
   ticks that the difference of two readings, each cut off to a whole tick, rounds to the exact count. */
#define SYST_CSR (*(volatile uint32_t *)0xE000E010u)
#define SYST_RVR (*(volatile uint32_t *)0xE000E014u)
#define SYST_CVR (*(volatile uint32_t *)0xE000E018u)
#define CPACR (*(volatile uint32_t *)0xE000ED88u)
#define RELOAD 0x00ffffffu
#define NS_PER_TICK 40u
#define NS_PER_INSTRUCTION 256u

extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;
void reset(void);
static void fault(void);

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &stack_top, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault};

/* The compiler may call these wherever arrays are copied or cleared. */
void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    for (size_t i = 0; i < n; i++)
        ((char *)to)[i] = ((const char *)from)[i];
    return to;
}

void *memset(void *to, int value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        ((char *)to)[i] = (char)value;
    return to;
}

static int host(int what, const void *with)
{
    register int r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void print(const char *text)
{
    host(0x04, text);
}

/* Ends the emulation; its exit status says whether all went well. */
static void end(int well)
{
    host(0x18, (const void *)(well ? 0x20026 : 0x20023));
    for (;;) {
    }
}

static void fault(void)
{
    print("fault\n");
    end(0);
}

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

static void run(void)
{
    static REAL out[3 * N];
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
}

void reset(void)
{
    CPACR |= 0xfu << 20; /* the floating-point unit */
    __asm__ volatile("dsb\n isb" ::: "memory");
    memcpy(&data_start, &data_load, (size_t)((char *)&data_end - (char *)&data_start));
    memset(&bss_start, 0, (size_t)((char *)&bss_end - (char *)&bss_start));
    SYST_RVR = RELOAD;
    SYST_CVR = 0;
    SYST_CSR = 5; /* on, from the core's clock, without interrupts */
    run();
    end(1);
}
