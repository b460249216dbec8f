"""The bits of 1 / (2 pi) in robstiff/src/trig/payne_hanek.rs, and how near numbers come to whole turns.

pi by Machin's formula in whole numbers. The nearest number of a mantissa's digits is a
denominator of the continued fraction of 2^e / (2 pi), for each exponent e (Kahan).

Plain Python, exact: python3 turns.py
"""

import math

BITS = 3000
ONE = 1 << BITS


def arctan_of_inverse(x):
    total = term = ONE // x
    n, sign = 3, -1
    while term:
        term //= x * x
        total += sign * (term // n)
        n, sign = n + 2, -sign
    return total


TURN = 8 * (4 * arctan_of_inverse(5) - arctan_of_inverse(239))


def limbs(bits, count):
    per_radian = (ONE << BITS) // TURN
    return [per_radian >> (BITS - bits * (i + 1)) & ((1 << bits) - 1) for i in range(count)]


def nearest(digits, exponents):
    """The least distance from a whole turn, in turns, as a power of two."""
    least = ONE
    for e in exponents:
        a, b = (ONE << e if e >= 0 else ONE >> -e), TURN
        whole, (k0, k) = a, (0, 1)
        a, b = b, a % b
        while b:
            k0, k = k, a // b * k + k0
            if k >= 1 << digits:
                break
            a, b = b, a % b
            # A multiple of it has the mantissa's length.
            times = 1 << max(0, digits - k.bit_length())
            rest = k * whole % TURN
            least = min(least, times * min(rest, TURN - rest))
    return math.log2(least / TURN)


for name, bits, count, digits, exponents in [("f64", 64, 19, 53, range(-52, 972)), ("f32", 32, 8, 24, range(-23, 105))]:
    numbers = [f"0x{limb:0{bits // 4}x}" for limb in limbs(bits, count)]
    print(name, ", ".join(numbers))
    print(f"no {name} is nearer to a whole turn than 2^{nearest(digits, exponents):.1f} of it")
