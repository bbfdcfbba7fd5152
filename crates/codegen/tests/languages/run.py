"""Runs a generated function on points from the standard input, all at once."""

import importlib
import sys

import numpy as np

module, function, dtype, *lengths = sys.argv[1:]
points = np.array([[float(x) for x in line.split()] for line in sys.stdin], dtype)
at, arguments = 0, []
for length in map(int, lengths):
    arguments.append(points[:, at : at + length])
    at += length
results = getattr(importlib.import_module(module), function)(*arguments)
flat = []
for result in results:
    if not arguments:
        # A constant has no states.
        result = result[np.newaxis].astype(dtype)
    assert result.dtype == dtype, (function, result.dtype)
    assert result.shape[0] == len(points), (function, result.shape)
    flat.append(result.reshape(len(points), -1))
np.savetxt(sys.stdout, np.hstack(flat), "%.17g")

# States along more than one axis, and arguments that are the same at all of them, are broadcast.
if arguments and len(points) % 2 == 0:
    folded = [a.reshape(2, len(points) // 2, -1) for a in arguments]
    again = getattr(importlib.import_module(module), function)(*folded)
    for one, two in zip(results, again):
        assert two.shape == (2, len(points) // 2, *one.shape[1:])
        assert np.array_equal(one, two.reshape(one.shape))
