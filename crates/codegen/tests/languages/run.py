"""Runs generated functions on points from the standard input, all points of a function at once.

    run.py MODULE FUNCTION:TYPE:POINTS:LENGTH,LENGTH... ...
"""

import importlib
import sys

import numpy as np


def run(function, dtype, points, lengths):
    at, arguments = 0, []
    for length in lengths:
        arguments.append(points[:, at : at + length])
        at += length
    results = function(*arguments)
    flat = []
    for result in results:
        if not arguments:
            # A constant has no states.
            result = result[np.newaxis].astype(dtype)
        assert result.dtype == dtype, (function, result.dtype)
        assert result.shape[0] == len(points), (function, result.shape)
        flat.append(result.reshape(len(points), -1))
    np.savetxt(sys.stdout, np.hstack(flat), "%.17g")

    # States along more than one axis are as good as along one.
    if arguments and len(points) % 2 == 0:
        again = function(*(a.reshape(2, len(points) // 2, -1) for a in arguments))
        for one, two in zip(results, again):
            assert two.shape == (2, len(points) // 2, *one.shape[1:])
            assert np.array_equal(one, two.reshape(one.shape))


module = importlib.import_module(sys.argv[1])
lines = iter(sys.stdin.readlines())
for what in sys.argv[2:]:
    name, dtype, count, lengths = what.split(":")
    points = np.array([[float(x) for x in next(lines).split()] for _ in range(int(count))], dtype)
    run(getattr(module, name), dtype, points, [int(length) for length in lengths.split(",") if length])
