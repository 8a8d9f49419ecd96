// SPDX-License-Identifier: MIT
// The C API: trajectories from files and from memory.
#include "capi/atoms_in.h"
#include "capi/choices.h"
#include "capi/structs.h"
#include "io/text.h"
#include "io/trajectory.h"
#include "quickses/quickses.h"

#include <cstring>
#include <optional>
#include <vector>

using quickses::check_atom_count;
using quickses::check_choice;
using quickses::guarded;
using quickses::invalid;
using quickses::own_choice;
using quickses::public_choice;
using quickses::require;
using quickses::write_struct;
namespace io = quickses::io;

struct qses_trajectory {
  explicit qses_trajectory(io::Trajectory opened) : frames(std::move(opened)), has_box(frames.box(0).has_value()) {}

  io::Trajectory frames;
  const bool has_box;
};

namespace {

constexpr qses_trajectory_format kFormats[] = {QSES_TRAJECTORY_DCD, QSES_TRAJECTORY_XTC, QSES_TRAJECTORY_PDB,
                                               QSES_TRAJECTORY_TRR, QSES_TRAJECTORY_NETCDF};

// By reference: a number that names no format must not be looked at as one before it is checked.
std::optional<io::TrajectoryFormat> format_of(const qses_trajectory_format &format) {
  check_choice("format", format, QSES_TRAJECTORY_NETCDF);
  return own_choice<io::TrajectoryFormat>(kFormats, format);
}

}  // namespace

extern "C" {

qses_status qses_trajectory_open(const char *path, qses_trajectory_format format, qses_trajectory **trajectory) {
  if (trajectory) *trajectory = nullptr;
  return guarded([&] {
    require(path, "path");
    require(trajectory, "trajectory");
    const std::optional<io::TrajectoryFormat> known = format_of(format);
    *trajectory = new qses_trajectory(known ? io::Trajectory::open(path, *known) : io::Trajectory::open(path));
  });
}

qses_status qses_trajectory_open_memory(const void *bytes, size_t size, qses_trajectory_format format,
                                        qses_trajectory **trajectory) {
  if (trajectory) *trajectory = nullptr;
  return guarded([&] {
    require(bytes, "bytes");
    require(trajectory, "trajectory");
    std::string copy(static_cast<const char *>(bytes), size);
    *trajectory = new qses_trajectory(io::Trajectory::from_memory(std::move(copy), format_of(format)));
  });
}

void qses_trajectory_close(qses_trajectory *trajectory) {
  guarded([&] { delete trajectory; });
}

qses_status qses_trajectory_info(const qses_trajectory *trajectory, qses_trajectory_description *description) {
  return guarded([&] {
    require(trajectory, "trajectory");
    require(description, "description");
    qses_trajectory_description value;
    qses_trajectory_description_init(&value);
    value.format = public_choice(kFormats, trajectory->frames.format());
    value.frame_count = trajectory->frames.frame_count();
    value.atom_count = static_cast<uint32_t>(trajectory->frames.atom_count());
    value.has_box = trajectory->has_box ? 1 : 0;
    value.is_unwrapped = trajectory->frames.is_unwrapped() ? 1 : 0;
    value.incomplete = trajectory->frames.incomplete() ? 1 : 0;
    value.warning_count = static_cast<uint32_t>(trajectory->frames.warnings().size());
    write_struct(description, value, "qses_trajectory_description");
  });
}

qses_status qses_trajectory_warning(const qses_trajectory *trajectory, uint32_t k, const char **sentence) {
  return guarded([&] {
    require(trajectory, "trajectory");
    require(sentence, "sentence");
    *sentence = quickses::pick(trajectory->frames.warnings(), k, "warning").c_str();
  });
}

qses_status qses_trajectory_unwrap(qses_trajectory *trajectory, const uint8_t *elements, size_t count) {
  return guarded([&] {
    require(trajectory, "trajectory");
    require(elements, "elements");
    check_atom_count(count, trajectory->frames.atom_count(), "trajectory");
    if (!trajectory->frames.unwrap(elements))
      throw quickses::Error(QSES_NO_BOX, "no frame has a periodic box: molecules are left as they are");
  });
}

qses_status qses_trajectory_read_frame(const qses_trajectory *trajectory, uint64_t index, float *positions,
                                       size_t stride, size_t count, qses_frame *frame) {
  return guarded([&] {
    require(trajectory, "trajectory");
    quickses::check_layout(positions, stride, count);
    check_atom_count(count, trajectory->frames.atom_count(), "trajectory");
    if (frame) quickses::check_struct(frame, "qses_frame");
    if (index >= trajectory->frames.frame_count())
      invalid("index is " + std::to_string(index) + " but the trajectory has " +
              io::counted(trajectory->frames.frame_count(), "frame"));
    const size_t k = static_cast<size_t>(index);
    qses_frame value;
    qses_frame_init(&value);
    const std::optional<io::Box> box = trajectory->frames.box(k);
    value.has_box = box ? 1 : 0;
    for (size_t i = 0; box && i < 9; ++i) value.box[i] = box->vectors[i / 3][i % 3];
    if (const std::optional<double> time = trajectory->frames.time(k)) {
      value.has_time = 1;
      value.time = *time;
    }
    if (stride == 0 || stride == 12) {
      value.is_unwrapped = trajectory->frames.read_frame(k, positions) ? 1 : 0;
    } else {
      std::vector<float> packed(3 * count);
      value.is_unwrapped = trajectory->frames.read_frame(k, packed.data()) ? 1 : 0;
      for (size_t i = 0; i < count; ++i)
        std::memcpy(reinterpret_cast<char *>(positions) + i * stride, &packed[3 * i], 12);
    }
    if (frame) write_struct(frame, value, "qses_frame");
  });
}

}  // extern "C"
