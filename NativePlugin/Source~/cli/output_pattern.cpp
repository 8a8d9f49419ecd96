// SPDX-License-Identifier: MIT
// Names of mesh files with the number of a frame in them.
#include "cli/output_pattern.h"

#include "cli/exit_code.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

constexpr size_t kMaxWidth = 20;

[[noreturn]] void fail(const std::string &text, const std::string &what) {
  throw Failure(kUsage, "--output (-o): '" + text + "' " + what);
}

}  // namespace

OutputPattern::OutputPattern(const std::string &text) {
  bool has_number = false;
  for (size_t i = 0; i < text.size(); ++i) {
    std::string &part = has_number ? after_ : before_;
    if (text[i] != '%') {
      part += text[i];
      continue;
    }
    if (text.compare(i, 2, "%%") == 0) {
      part += '%';
      ++i;
      continue;
    }
    const size_t start = i++;
    if (has_number) fail(text, "has two places for the frame's number: one %d is needed, and %% for a percent sign");
    if (i < text.size() && text[i] == '0') fill_ = '0';
    for (; i < text.size() && io::is_digit(text[i]) && width_ <= kMaxWidth; ++i)
      width_ = 10 * width_ + static_cast<size_t>(text[i] - '0');
    if (i == text.size() || text[i] != 'd' || width_ > kMaxWidth)
      fail(text,
           "has '" + text.substr(start, i - start + 1) + "': the place of the frame's number is written %d or %05d");
    has_number = true;
  }
  if (!has_number)
    fail(text, "names one file for all frames: write %d or %05d where the frame's number goes, as in frame_%05d.ply");
}

std::string OutputPattern::name(size_t frame) const {
  std::string number = std::to_string(frame);
  if (number.size() < width_) number.insert(0, width_ - number.size(), fill_);
  return before_ + number + after_;
}

}  // namespace quickses::cli
