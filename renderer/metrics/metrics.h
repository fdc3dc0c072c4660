#pragma once

#include "renderer/image.h"

/// Picture comparison: pure functions. Pictures are sRGB-encoded with 3 or 4 channels, alpha is
/// ignored; both must have the same size, otherwise bad_value.
namespace penumbra::metrics {

/// Root of the mean squared difference of Y = 0.299 R + 0.587 G + 0.114 B, encoded, in 0..255.
/// Source: van Sambeek 2007, 4.1.2.
double rms_y(const Image8& picture, const Image8& reference);

/// Peak signal-to-noise ratio over R, G, B in decibels, peak 255; infinity for equal pictures.
double psnr(const Image8& picture, const Image8& reference);

/// Mean structural similarity of Y: 11x11 Gaussian window, sigma 1.5, K1 0.01, K2 0.03, only where
/// the window fits. Source: Wang et al. 2004. At least 11x11 pixels, smaller pictures: bad_value.
double ssim(const Image8& picture, const Image8& reference);

/// Mean FLIP error, LDR, 0..1; pixels_per_degree of visual angle 1..1000 (67: a 0.7 m wide 4K
/// screen seen from 0.7 m). Borders repeat. Source: Andersson et al. 2020.
double flip(const Image8& picture, const Image8& reference, double pixels_per_degree = 67.0);

/// The same for pictures of more than 8 bits: encoded levels 0..255 with fractions.
double rms_y(const ImageF& picture, const ImageF& reference);
double psnr(const ImageF& picture, const ImageF& reference);
double ssim(const ImageF& picture, const ImageF& reference);
double flip(const ImageF& picture, const ImageF& reference, double pixels_per_degree = 67.0);

/// Of visibility pictures (one channel per light), over pixels with judged > 0.5 of their channel.
/// A visibility that is no finite number counts as the one farthest from the reference. All zero
/// where nothing is judged.
struct VisibilityError {
  double rms = 0.0;
  double bias = 0.0;            ///< mean of picture - reference: negative is too dark
  double false_shadow = 0.0;    ///< share darker than the reference by more than 0.1
  double missing_shadow = 0.0;  ///< share lighter than the reference by more than 0.1
  std::size_t judged = 0;       ///< pixels times lights that were judged
};
VisibilityError visibility_error(const ImageF& visibility, const ImageF& reference,
                                 const ImageF& judged);

/// Signed error of Y as an RGBA picture: white where exact, blue too dark, red too bright; full
/// colour at a difference of `full_scale` (above 0, at most 255).
Image8 error_map(const Image8& picture, const Image8& reference, double full_scale = 64.0);

}  // namespace penumbra::metrics
