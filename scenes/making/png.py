"""PNG files and the noise that textures are made of."""

import math
import struct
import zlib


def write(path, width, height, pixel):
    """pixel(u, v) gives 1, 3 or 4 numbers from 0 to 1, encoded as they are; v runs upward as in OBJ."""
    rows, channels = [], None
    for y in range(height):
        row = bytearray()
        for x in range(width):
            values = pixel((x + 0.5) / width, 1 - (y + 0.5) / height)
            channels = channels or len(values)
            row += bytes(min(255, max(0, int(v * 255 + 0.5))) for v in values)
        rows.append(row)
    data = bytearray()
    previous = bytes(width * channels)
    for row in rows:
        # Of the filters none, left and up, the one with the smallest sum of differences.
        left = bytes((row[i] - (row[i - channels] if i >= channels else 0)) & 255 for i in range(len(row)))
        up = bytes((a - b) & 255 for a, b in zip(row, previous))
        cost = lambda line: sum(min(b, 256 - b) for b in line)
        best = min(((0, bytes(row)), (1, left), (2, up)), key=lambda choice: cost(choice[1]))
        data += bytes([best[0]]) + best[1]
        previous = row
    kind = {1: 0, 3: 2, 4: 6}[channels]
    with open(path, 'wb') as file:
        file.write(b'\x89PNG\r\n\x1a\n')
        for name, body in (
            (b'IHDR', struct.pack('>IIBBBBB', width, height, 8, kind, 0, 0, 0)),
            (b'IDAT', zlib.compress(bytes(data), 9)),
            (b'IEND', b''),
        ):
            file.write(struct.pack('>I', len(body)) + name + body + struct.pack('>I', zlib.crc32(name + body)))


def hash01(*keys):
    """A number in [0, 1) from integers."""
    h = 0x9E3779B9
    for key in keys:
        h = ((h ^ (int(key) & 0xFFFFFFFF)) * 0x85EBCA6B) & 0xFFFFFFFF
        h ^= h >> 13
        h = (h * 0xC2B2AE35) & 0xFFFFFFFF
        h ^= h >> 16
    return h / 2**32


def noise(x, y, period, seed=0):
    """Smooth noise in [0, 1) on a grid of unit cells that repeats after `period` cells (an integer)."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    at = lambda a, b: hash01((i + a) % period, (j + b) % period, seed)
    low = at(0, 0) * (1 - u) + at(1, 0) * u
    high = at(0, 1) * (1 - u) + at(1, 1) * u
    return low * (1 - v) + high * v


def fractal(x, y, period, octaves, seed=0):
    """Noise of halving amplitude and size, in [0, 1)."""
    total, amplitude, norm = 0, 1, 0
    for octave in range(octaves):
        total += amplitude * noise(x, y, period, seed + octave)
        norm += amplitude
        amplitude, x, y, period = amplitude / 2, x * 2, y * 2, period * 2
    return total / norm


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def normal_map(height, u, v, step):
    """The encoded normal of the function height(u, v), heights in units of the texture's width."""
    dx = (height(u + step, v) - height(u - step, v)) / (2 * step)
    dy = (height(u, v + step) - height(u, v - step)) / (2 * step)
    length = math.sqrt(dx * dx + dy * dy + 1)
    return tuple(0.5 + 0.5 * x / length for x in (-dx, -dy, 1))
