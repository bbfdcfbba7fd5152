"""Counts the instructions between two passes of a program's mark by stepping through them.

Emulators that count, callgrind for one, do not know every instruction of the processors they run on, and choose other ones than the
processor would; the processor's own counters are closed to most virtual machines. Stepping needs neither.
"""

import ctypes
import os
import signal
import subprocess
import sys

PEEKTEXT, PEEKUSER, POKETEXT, POKEUSER, CONT, SINGLESTEP, ATTACH = 1, 3, 4, 6, 7, 9, 16
RIP = 16 * 8  # its place among the registers
BREAKPOINT = 0xCC

libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.restype = ctypes.c_long
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_ulong, ctypes.c_ulong]


class Traced:
    """A process that stands still between our calls."""

    def __init__(self, pid):
        self.pid = pid
        self.ask(ATTACH)
        self.wait()

    def ask(self, request, address=0, data=0):
        ctypes.set_errno(0)
        answer = libc.ptrace(request, self.pid, address, data)
        if answer == -1 and ctypes.get_errno():
            sys.exit(f"ptrace: {os.strerror(ctypes.get_errno())}; this machine does not let a program step through another")
        return answer & (2**64 - 1)

    def wait(self):
        """Until it stops; false if it has ended."""
        _, status = os.waitpid(self.pid, 0)
        if os.WIFSTOPPED(status):
            return True
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 0:
            return False
        sys.exit("the program to be counted did not come to its end")

    def steps_until(self, address):
        """Instructions executed until the next one is at `address`."""
        count = 0
        while True:
            self.ask(SINGLESTEP)
            if not self.wait():
                sys.exit("the program to be counted has ended before its second mark")
            count += 1
            if self.ask(PEEKUSER, RIP) == address:
                return count

    def run_to(self, address):
        """At full speed; false if the program ends first."""
        code = self.ask(PEEKTEXT, address)
        self.ask(POKETEXT, address, code & ~0xFF | BREAKPOINT)
        while True:
            self.ask(CONT)
            if not self.wait():
                return False
            if self.ask(PEEKUSER, RIP) == address + 1:
                break
        self.ask(POKETEXT, address, code)
        self.ask(POKEUSER, RIP, address)
        return True


def counts(program):
    """Yields each case of the program with its instructions, without those of the mark itself."""
    process = subprocess.Popen([str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        mark = int(process.stdout.readline(), 16)
        traced = Traced(process.pid)
        process.stdin.write("\n")
        process.stdin.flush()
        found = []
        while traced.run_to(mark):
            found.append(traced.steps_until(mark))
            # Leave the mark, or the breakpoint would stop at it once more.
            traced.ask(SINGLESTEP)
            traced.wait()
        names = process.stdout.read().split("\n")[:-1]
    except BaseException:
        process.send_signal(signal.SIGKILL)
        raise
    if len(names) != len(found):
        sys.exit(f"{len(names)} cases were named, but {len(found)} counted")
    for name, count in zip(names[1:], found[1:]):
        yield name, count - found[0]
