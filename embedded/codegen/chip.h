#ifndef CHIP_H
#define CHIP_H

#include <stddef.h>
#include <stdint.h>

/* What a program does; whether all went well. */
int run(void);

/* Asks the debugger. */
int32_t host(int32_t what, const void *with);

void print(const char *text);

/* Ends the emulation; its exit status says whether all went well. */
void end(int well);

#endif
