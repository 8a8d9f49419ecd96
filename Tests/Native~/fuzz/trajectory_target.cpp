// SPDX-License-Identifier: MIT
// Any bytes as a trajectory; the very last byte names the format.
#include "fuzz/fuzz.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fuzz {
namespace {

void check_frame(const qses_trajectory *trajectory, const qses_trajectory_description &about, uint64_t index) {
  constexpr float kBetween = 4711;
  constexpr size_t kFloats = 4;
  std::vector<float> positions(about.atom_count * kFloats, kBetween);
  qses_frame frame;
  qses_frame_init(&frame);
  if (!succeeds(qses_trajectory_read_frame(trajectory, index, positions.data(), kFloats * sizeof(float),
                                           about.atom_count, &frame),
                {QSES_FILE_ERROR}))
    return;
  for (size_t k = 0; k < positions.size(); ++k)
    require(k % kFloats == 3 ? positions[k] == kBetween : is_position(positions[k]), "positions, and nothing between");
  require(!frame.has_time || std::isfinite(frame.time), "a time");
  for (const double x : frame.box) require(std::isfinite(x) && (frame.has_box || x == 0), "a box, or zeros");
}

}  // namespace

void try_trajectory(const uint8_t *data, size_t size) {
  qses_input_set_limit(kInputLimit);
  Choices in(data, size);
  const auto format = static_cast<qses_trajectory_format>(in.below(QSES_TRAJECTORY_NETCDF + 1));
  const bool unwraps = in.yes();
  const std::vector<uint8_t> file = in.rest();
  qses_trajectory *trajectory = nullptr;
  if (!succeeds(qses_trajectory_open_memory(file.data(), file.size(), format, &trajectory),
                {QSES_INVALID_ARGUMENT, QSES_FILE_ERROR})) {
    require(trajectory == nullptr, "none after a failure");
    return;
  }
  qses_trajectory_description about;
  qses_trajectory_description_init(&about);
  require(succeeds(qses_trajectory_info(trajectory, &about), {}), "it is told of");
  require(about.frame_count > 0 && about.atom_count > 0, "at least one frame, of at least one atom");
  constexpr uint32_t kManyAtoms = 100000;  // those of frames that hold next to nothing take their time
  if (about.atom_count <= kManyAtoms) {
    if (unwraps) {
      const std::vector<uint8_t> elements(about.atom_count, 6);
      succeeds(qses_trajectory_unwrap(trajectory, elements.data(), elements.size()), {QSES_NO_BOX, QSES_FILE_ERROR});
    }
    constexpr uint64_t kFrames = 3;
    for (uint64_t k = 0; k < std::min(about.frame_count, kFrames); ++k) check_frame(trajectory, about, k);
    check_frame(trajectory, about, about.frame_count - 1);
  }
  for (uint32_t k = 0; k < about.warning_count; ++k) {
    const char *sentence = nullptr;
    require(succeeds(qses_trajectory_warning(trajectory, k, &sentence), {}) && sentence[0] != '\0', "a sentence");
  }
  qses_trajectory_close(trajectory);
}

}  // namespace fuzz
