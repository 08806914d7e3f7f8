#!/usr/bin/env python3
"""Makes the table of src/bsdf/metals.rs from measured spectra: `python3 scenes/metals.py`.

A channel's eta is the mean of the measured one, weighted by how much each wavelength adds to the channel (and
not by how much it takes away). Its k is then the one that reflects, at normal incidence, what integrating the
measured reflectance over the spectrum gives: reflected daylight in linear Rec. 709, over the same of a perfect
mirror. So the colour seen head-on is the metal's own, and Fresnel's equations keep their say at other angles.

Illuminant: D65, the white of Rec. 709. Observer: CIE 1931, 2 degrees. Gold's red lies outside of Rec. 709, above
1, and is clipped. Needs nothing but Python.
"""

import math

# What a channel may reflect at most.
BRIGHTEST = 0.999

# CIE standard illuminant D65, 380 to 780 nm in steps of 10 (CIE 015:2018, rounded to 0.1); linear in between.
D65 = [50.0, 54.6, 82.8, 91.5, 93.4, 86.7, 104.9, 117.0, 117.8, 114.9, 115.9, 108.8, 109.4, 107.8, 104.8, 107.7, 104.4,
       104.0, 100.0, 96.3, 95.8, 88.7, 90.0, 89.6, 87.7, 83.3, 83.7, 80.0, 80.2, 82.3, 78.3, 69.7, 71.6, 74.3, 61.6,
       69.9, 75.1, 63.6, 46.4, 66.8, 63.4]

# XYZ to linear Rec. 709 (IEC 61966-2-1).
REC709 = [(3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570)]

# Wavelengths in nm of Johnson and Christy's measurements in eV: noble metals, transition metals.
NOBLE = '367.9 381.5 397.4 413.3 430.5 450.9 471.4 495.9 520.9 548.6 582.1 616.8 659.5 704.5 756 821.1'
TRANSITION = '368 381 397 413 431 451 471 496 521 549 582 617 659 704 756 821'
EVERY_20 = ' '.join(str(nm) for nm in range(380, 761, 20))

# Metal: wavelengths, eta, k. The numbers are those of refractiveindex.info (public domain); of gold and tungsten,
# which it has more finely, every 20 nm.
METALS = {
    # A. Rakic, Applied Optics 34, 4755 (1995).
    'aluminium': ('364.7 413.3 442.8 476.9 516.6 563.6 619.9 652.2 688.8 729.3 774.9',
                  '0.399 0.521 0.608 0.728 0.873 1.073 1.366 1.572 1.83 2.161 2.615',
                  '4.396 5.001 5.368 5.778 6.242 6.784 7.405 7.735 8.06 8.357 8.491'),
    # P. Johnson and R. Christy, Phys. Rev. B 9, 5056 (1974).
    'chromium': (TRANSITION,
                 '1.87 1.92 2 2.08 2.19 2.33 2.51 2.75 2.94 3.18 3.22 3.17 3.09 3.05 3.08 3.2',
                 '2.69 2.74 2.83 2.93 3.04 3.14 3.24 3.3 3.33 3.33 3.3 3.3 3.34 3.39 3.42 3.48'),
    # The same.
    'cobalt': (TRANSITION,
               '1.5 1.53 1.57 1.61 1.67 1.74 1.81 1.88 1.97 2.05 2.13 2.19 2.25 2.31 2.4 2.53',
               '2.71 2.82 2.93 3.05 3.17 3.28 3.41 3.55 3.68 3.82 3.96 4.11 4.27 4.45 4.64 4.88'),
    # P. Johnson and R. Christy, Phys. Rev. B 6, 4370 (1972).
    'copper': (NOBLE,
               '1.36 1.33 1.32 1.28 1.25 1.24 1.25 1.22 1.18 1.02 0.7 0.3 0.22 0.21 0.24 0.26',
               '1.975 2.045 2.116 2.207 2.305 2.397 2.483 2.564 2.608 2.577 2.704 3.205 3.747 4.205 4.665 5.18'),
    # R. Olmon et al., Phys. Rev. B 86, 235147 (2012), evaporated. Later measurements agree with it (McPeak et al.
    # 2015, Yakubovsky et al. 2017, Magnozzi et al. 2019); Johnson and Christy's gold reflects 6 % less green.
    'gold': (EVERY_20,
             '1.588 1.588 1.567 1.505 1.422 1.193 0.82 0.526 0.372 0.29 0.239 0.204 0.179 0.162 0.149 0.139 0.133 '
             '0.128 0.126 0.124',
             '1.877 1.915 1.898 1.877 1.812 1.716 1.787 2.058 2.364 2.641 2.891 3.122 3.34 3.547 3.746 3.938 4.126 '
             '4.308 4.487 4.662'),
    # Johnson and Christy (1974).
    'iron': (TRANSITION,
             '2.02 2.12 2.24 2.35 2.48 2.59 2.67 2.74 2.86 2.95 2.94 2.88 2.92 2.86 2.87 2.94',
             '2.43 2.5 2.58 2.65 2.71 2.77 2.82 2.88 2.91 2.93 2.99 3.05 3.1 3.19 3.28 3.39'),
    # The same.
    'nickel': (TRANSITION,
               '1.7 1.72 1.72 1.7 1.71 1.73 1.78 1.82 1.85 1.92 1.96 1.99 1.99 2.06 2.13 2.26',
               '2.4 2.48 2.57 2.69 2.82 2.95 3.09 3.25 3.42 3.61 3.8 4.02 4.26 4.5 4.73 4.97'),
    # The same.
    'palladium': (TRANSITION,
                  '1.24 1.26 1.3 1.33 1.37 1.41 1.46 1.52 1.57 1.64 1.68 1.75 1.8 1.86 1.95 2.06',
                  '2.74 2.83 2.93 3.03 3.14 3.26 3.39 3.54 3.68 3.84 4.02 4.21 4.42 4.65 4.89 5.19'),
    # Johnson and Christy (1972).
    'silver': (NOBLE,
               '0.07 0.05 0.05 0.05 0.04 0.04 0.05 0.05 0.05 0.06 0.05 0.06 0.05 0.04 0.03 0.04',
               '1.657 1.864 2.07 2.275 2.462 2.657 2.869 3.093 3.324 3.586 3.858 4.152 4.483 4.838 5.242 5.727'),
    # Johnson and Christy (1974).
    'titanium': (TRANSITION,
                 '1.9 1.99 2.08 2.14 2.21 2.27 2.32 2.36 2.44 2.54 2.6 2.67 2.76 2.86 3 3.21',
                 '2.9 2.93 2.95 2.98 3.01 3.04 3.1 3.19 3.3 3.43 3.58 3.72 3.84 3.96 4.01 4.01'),
    # J. Weaver et al., Phys. Rev. B 12, 1293 (1975).
    'tungsten': (EVERY_20,
                 '3.459 3.407 3.359 3.321 3.322 3.354 3.402 3.46 3.508 3.523 3.533 3.558 3.596 3.642 3.707 3.793 3.868 '
                 '3.895 3.879 3.842',
                 '2.547 2.416 2.43 2.481 2.555 2.625 2.68 2.708 2.728 2.764 2.81 2.861 2.896 2.919 2.942 2.916 2.88 '
                 '2.846 2.812 2.774'),
}


def interpolate(x, xs, ys):
    """Linear between the points, constant beyond them."""
    if x <= xs[0]:
        return ys[0]
    for x0, x1, y0, y1 in zip(xs, xs[1:], ys, ys[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return ys[-1]


def observer(nm):
    """XYZ of a wavelength: the multi-lobe fit of C. Wyman, P. Sloan and P. Shirley, JCGT 2(2), 2013."""
    def lobe(height, mean, left, right):
        return height * math.exp(-0.5 * ((nm - mean) * (left if nm < mean else right)) ** 2)

    return (lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
            lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
            lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725))


def reflectance(eta, k):
    """At normal incidence."""
    return ((eta - 1) ** 2 + k * k) / ((eta + 1) ** 2 + k * k)


def extinction(eta, reflected):
    """The k that makes `reflectance` be `reflected`."""
    return math.sqrt((reflected * (eta + 1) ** 2 - (eta - 1) ** 2) / (1 - reflected))


def channel(row, spectrum):
    """(eta, k, spectral reflectance) of the channel that `row` of the matrix makes. `spectrum`: (nm, eta, k)."""
    weights = [light * math.fsum(a * b for a, b in zip(row, observer(nm))) for light, (nm, _, _) in zip(D65, spectrum)]
    seen = math.fsum(w * reflectance(eta, k) for w, (_, eta, k) in zip(weights, spectrum)) / math.fsum(weights)
    adding = [max(w, 0) for w in weights]
    eta = round(math.fsum(w * eta for w, (_, eta, _) in zip(adding, spectrum)) / math.fsum(adding), 3)
    return eta, extinction(eta, min(seen, BRIGHTEST)), seen


if __name__ == '__main__':
    for name, table in METALS.items():
        wavelengths, etas, ks = ([float(number) for number in column.split()] for column in table)
        spectrum = [(nm, interpolate(nm, wavelengths, etas), interpolate(nm, wavelengths, ks))
                    for nm in range(380, 781, 10)]
        eta, k, seen = zip(*(channel(row, spectrum) for row in REC709))
        eta, k, seen = (', '.join(f'{x:.3f}' for x in numbers) for numbers in (eta, k, seen))
        print(f'    metal("{name}", [{eta}], [{k}]), // [{seen}]')
