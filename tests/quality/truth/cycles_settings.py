# SPDX-License-Identifier: GPL-3.0-or-later
"""How Cycles renders the truth. A change of this file renders it anew."""

# Direct light alone at pixel centres, without anything that trades truth for noise.
SETTINGS = {
    "device": "CPU", "max_bounces": 0, "use_adaptive_sampling": False, "use_denoising": False, "use_light_tree": False,
    "light_sampling_threshold": 0.0, "sample_clamp_direct": 0.0, "sample_clamp_indirect": 0.0,
    "pixel_filter_type": "BLACKMAN_HARRIS", "filter_width": 0.01,
}
# Without bounces only light samples count, so they must carry the full weight.
USE_MULTIPLE_IMPORTANCE_SAMPLING = False
