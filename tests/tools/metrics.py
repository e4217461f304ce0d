# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of `penumbra compare`, computed the slow and plain way."""

import math


def rmse(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))


def ssim(a, b, width, height, counts):
    """Mean structural similarity of two grey images over the pixels where counts is true (Wang et al. 2004)."""
    weights = {(dx, dy): math.exp(-(dx * dx + dy * dy) / (2 * 1.5 ** 2)) for dx in range(-5, 6) for dy in range(-5, 6)}
    values = []
    for y in range(height):
        for x in range(width):
            if not counts[y * width + x]:
                continue
            window = [(weight, (y + dy) * width + x + dx) for (dx, dy), weight in weights.items()
                      if 0 <= x + dx < width and 0 <= y + dy < height and counts[(y + dy) * width + x + dx]]
            total = sum(weight for weight, _ in window)
            mean_a = sum(weight * a[i] for weight, i in window) / total
            mean_b = sum(weight * b[i] for weight, i in window) / total
            variance_a = sum(weight * (a[i] - mean_a) ** 2 for weight, i in window) / total
            variance_b = sum(weight * (b[i] - mean_b) ** 2 for weight, i in window) / total
            covariance = sum(weight * (a[i] - mean_a) * (b[i] - mean_b) for weight, i in window) / total
            values.append((2 * mean_a * mean_b + 1e-4) * (2 * covariance + 9e-4) /
                          ((mean_a ** 2 + mean_b ** 2 + 1e-4) * (variance_a + variance_b + 9e-4)))
    return sum(values) / len(values)
