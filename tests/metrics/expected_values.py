#!/usr/bin/env python3
"""Prints the values that similarity_test.cpp and flip_test.cpp expect.

Not part of the tests: it records where their numbers come from. SSIM is scikit-image's; FLIP is
written down here from the paper in its plain form, with whole two-dimensional kernels, so that it
shares nothing with the separable, row by row C++. Needs numpy, scipy and scikit-image
(Debian: python3-skimage).

`expected_values.py FOLDER` writes the pair of pictures whose SSIM is published for IPOL's imdiff
(Getreuer 2011, doi 10.5201/ipol.2011.g_lmii, quoted by scikit-image's tests): 0.357959.
`penumbra compare FOLDER/camera.png FOLDER/camera-noisy.png` says 0.357964.
"""
import sys

import numpy as np
from scipy.ndimage import correlate
from skimage.metrics import structural_similarity


def noise(width, height, seed):
    """The same hash as noise() in pictures.h."""
    picture = np.zeros((height, width, 3), np.uint8)
    for y in range(height):
        for x in range(width):
            for c in range(3):
                h = (x * 73856093) ^ (y * 19349663) ^ (c * 83492791) ^ (seed * 2971215073)
                h = ((h & 0xFFFFFFFF) * 2654435761) & 0xFFFFFFFF
                picture[y, x, c] = h >> 24
    return picture


def shadow(width, height, inner, outer):
    """The same disc as shadow() in pictures.h: dark within `inner`, lit beyond `outer`."""
    picture = np.zeros((height, width, 3), np.uint8)
    low, high = 4 * inner * inner, 4 * outer * outer
    for y in range(height):
        for x in range(width):
            square = (2 * x - width) ** 2 + (2 * y - height) ** 2
            lit = min(max((square - low) * 64 // max(high - low, 1), 0), 64)
            for c, base in enumerate((230, 190, 130)):
                picture[y, x, c] = base * (16 + 48 * lit // 64) // 64
    return picture


def constant(width, height, rgb):
    return np.full((height, width, 3), rgb, np.uint8)


def patched(picture):
    """The same patches as patched() in pictures.h."""
    changed = picture.copy()
    for rows, columns in ((slice(0, 4), slice(0, 5)), (slice(70, 75), slice(93, 100)),
                          (slice(-1, None), slice(-1, None))):
        changed[rows, columns] = 255 - picture[rows, columns]
    return changed


def ssim(a, b):
    """Wang et al. 2004 on unrounded Y; scikit-image leaves out the border like the C++."""
    weights = np.array([0.299, 0.587, 0.114])
    return structural_similarity(a @ weights, b @ weights, data_range=255, gaussian_weights=True,
                                 sigma=1.5, use_sample_covariance=False)


TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                   [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                   [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(axis=1)


def opponent(srgb):
    v = srgb / 255.0
    linear = np.where(v > 0.04045, ((v + 0.055) / 1.055) ** 2.4, v / 12.92)
    x, y, z = np.moveaxis(linear @ TO_XYZ.T / WHITE, -1, 0)
    return np.stack((116 * y - 16, 500 * (x - y), 200 * (y - z)))


def hunt_lab(linear):
    t = linear @ TO_XYZ.T / WHITE
    d = 6 / 29
    x, y, z = np.moveaxis(np.where(t > d ** 3, np.cbrt(t), t / (3 * d * d) + 4 / 29), -1, 0)
    lightness = 116 * y - 16
    return np.stack((lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)))


def csf_filtered_lab(ycc, ppd):
    radius = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi ** 2)) * ppd))
    x, y = np.meshgrid(range(-radius, radius + 1), range(-radius, radius + 1))
    square = (x ** 2 + y ** 2) / ppd ** 2
    filtered = []
    for plane, terms in zip(ycc, ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])):
        kernel = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi ** 2 * square / b) for a, b in terms)
        filtered.append(correlate(plane, kernel / kernel.sum(), mode='nearest'))
    y = (filtered[0] + 16) / 116
    xyz = np.stack((y + filtered[1] / 500, y, y - filtered[2] / 200), axis=-1) * WHITE
    return hunt_lab(np.clip(xyz @ np.linalg.inv(TO_XYZ).T, 0, 1))


def features(ycc, ppd):
    sd = 0.5 * 0.082 * ppd
    radius = int(np.ceil(3 * sd))
    x, y = np.meshgrid(range(-radius, radius + 1), range(-radius, radius + 1))
    g = np.exp(-(x ** 2 + y ** 2) / (2 * sd * sd))
    lengths = []
    for kernel in (-x * g, (x ** 2 / sd ** 2 - 1) * g):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(),
                          kernel / -kernel[kernel < 0].sum())
        normalized = (ycc[0] + 16) / 116
        lengths.append(np.hypot(correlate(normalized, kernel, mode='nearest'),
                                correlate(normalized, kernel.T, mode='nearest')))
    return lengths


def hyab(a, b):
    return abs(a[0] - b[0]) + np.hypot(a[1] - b[1], a[2] - b[2])


def flip(a, b, ppd=67.0):
    ya, yb = opponent(a), opponent(b)
    largest = hyab(hunt_lab(np.array([0.0, 1, 0])), hunt_lab(np.array([0.0, 0, 1]))) ** 0.7
    power = hyab(csf_filtered_lab(ya, ppd), csf_filtered_lab(yb, ppd)) ** 0.7
    knee = 0.4 * largest
    color = np.where(power < knee, 0.95 * power / knee,
                     0.95 + 0.05 * (power - knee) / (largest - knee))
    ea, pa = features(ya, ppd)
    eb, pb = features(yb, ppd)
    feature = np.sqrt(np.maximum(abs(ea - eb), abs(pa - pb)) / np.sqrt(2))
    return (color ** (1 - feature)).mean()


def write_published_pair(folder):
    from skimage import data, io
    camera = data.camera()
    np.random.seed(5)
    noisy = np.clip(camera + 20.0 * np.random.randn(*camera.shape), 0, 255).astype(np.uint8)
    io.imsave(folder + '/camera.png', camera)
    io.imsave(folder + '/camera-noisy.png', noisy)


if __name__ == '__main__':
    if len(sys.argv) > 1:
        write_published_pair(sys.argv[1])
        sys.exit()
    n1, n2 = noise(48, 40, 1), noise(48, 40, 2)
    hard, soft = shadow(96, 64, 20, 21), shadow(96, 64, 14, 27)
    faint = (n1.astype(int) * 7 // 8 + 16).astype(np.uint8)
    print('ssim noise   ', repr(ssim(n1, n2)))
    print('ssim faint   ', repr(ssim(faint, n1)))
    print('ssim shadow  ', repr(ssim(soft, hard)))
    print('flip noise   ', repr(flip(n1, n2)))
    print('flip faint   ', repr(flip(faint, n1)))
    print('flip shadow  ', repr(flip(soft, hard)))
    print('flip shadow at 20 ppd', repr(flip(soft, hard, 20.0)))
    wide = shadow(200, 150, 40, 60)
    print('flip patched ', repr(flip(patched(wide), wide)))
    print('flip narrow  ', repr(flip(noise(5, 3, 1), noise(5, 3, 2))))
    for a, b in (((0, 0, 0), (255, 255, 255)), ((0, 255, 0), (0, 0, 255)), ((128, 128, 128),
                 (131, 128, 128)), ((255, 0, 0), (0, 255, 255)), ((10, 20, 30), (200, 40, 60))):
        print('flip', a, b, repr(flip(constant(4, 4, a), constant(4, 4, b))))
