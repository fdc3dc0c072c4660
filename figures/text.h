#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra::figures {

/// Text for XML and HTML: & < > " ' become references; what XML 1.0 forbids (control characters,
/// bytes that are no UTF-8) becomes U+FFFD.
std::string escaped(std::string_view text);

/// Width in points of one line at `size` points in DejaVu Sans, the widest of the fonts that the
/// figures name, so that text that fits here fits in Helvetica and Arial too.
double text_width(std::string_view text, double size);

/// Lines of at most `width` points: broken at blanks, after - _ / and, where a word is too long by
/// itself, anywhere. Never empty.
std::vector<std::string> wrapped(std::string_view text, double width, double size);

/// Length of the UTF-8 sequence that begins here; 0 where there is none (RFC 3629).
std::size_t utf8_length(std::string_view text);

/// A number with at most `decimals` digits behind the point, zeros at its end dropped, never "-0".
std::string number_text(double value, int decimals);

/// The same with exactly `decimals` digits.
std::string fixed_text(double value, int decimals);

/// For readers: like fixed_text, with a typographic minus (U+2212).
std::string shown_number(double value, int decimals);

}  // namespace penumbra::figures
