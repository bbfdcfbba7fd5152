/* Runs every function that was generated for a robot at the points of a file, NAME.in, and writes NAME.out: numbers as they lie
   in memory. On the chip the debugger reads and writes; with HOST it is a program like any other. `functions.h` has the table. */

#include "arm.h"
#include "functions.h"

#ifdef HOST

#include <stdio.h>

typedef FILE *File;
static File open_file(const char *name, int write) { return fopen(name, write ? "wb" : "rb"); }
static int is_open(File file) { return file != NULL; }
static int read_all(File file, void *to, size_t n) { return fread(to, 1, n, file) == n; }
static int write_all(File file, const void *from, size_t n) { return fwrite(from, 1, n, file) == n; }
static void close_file(File file) { fclose(file); }
static void print(const char *text) { fputs(text, stderr); }
int run(void);

int main(void) { return !run(); }

#else

#include "chip.h"

typedef int32_t File;

static size_t length(const char *text)
{
    size_t n = 0;
    while (text[n])
        n++;
    return n;
}

static File open_file(const char *name, int write)
{
    /* Modes are counted as those of fopen: r, rb, r+, r+b, w, wb. */
    const uint32_t with[3] = {(uint32_t)name, write ? 5 : 1, length(name)};
    return host(0x01, with);
}

static int is_open(File file) { return file != -1; }

static int read_all(File file, void *to, size_t n)
{
    const uint32_t with[3] = {(uint32_t)file, (uint32_t)to, n};
    return host(0x06, with) == 0;
}

static int write_all(File file, const void *from, size_t n)
{
    const uint32_t with[3] = {(uint32_t)file, (uint32_t)from, n};
    return host(0x05, with) == 0;
}

static void close_file(File file)
{
    const uint32_t with[1] = {(uint32_t)file};
    host(0x02, with);
}

#endif

static int run_function(const struct function *f)
{
    static REAL in[MOST_IN + 1], out[MOST_OUT];
    File from = open_file(f->in_file, 0), to = open_file(f->out_file, 1);
    if (!is_open(from) || !is_open(to))
        return 0;
    for (int k = 0; k < f->points; k++) {
        /* A constant takes nothing. */
        if (f->in > 0 && !read_all(from, in, sizeof(REAL) * (size_t)f->in))
            return 0;
        f->run(in, out);
        if (!write_all(to, out, sizeof(REAL) * (size_t)f->out))
            return 0;
    }
    close_file(from);
    close_file(to);
    return 1;
}

int run(void)
{
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        if (!run_function(&functions[i])) {
            print(functions[i].in_file);
            print(": its points cannot be read, or its results written\n");
            return 0;
        }
    }
    return 1;
}
