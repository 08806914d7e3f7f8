"""Radiance HDR files (RGBE), for images of what surrounds a scene."""

import math


def write(path, width, height, radiance):
    """radiance(u, v) gives three numbers, at least 0; v runs upward."""
    data = bytearray()
    for y in range(height):
        for x in range(width):
            color = radiance((x + 0.5) / width, 1 - (y + 0.5) / height)
            # One exponent for the three: 256 times the mantissa of the largest is below 256.
            exponent = math.frexp(max(*color, 1e-9))[1]
            data += bytes(int(c * 256 / 2.0**exponent) for c in color) + bytes([exponent + 128])
    with open(path, 'wb') as file:
        file.write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n' + f'-Y {height} +X {width}\n'.encode() + data)
