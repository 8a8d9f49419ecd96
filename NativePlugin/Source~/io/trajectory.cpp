// SPDX-License-Identifier: MIT
// Trajectories: choice of the format, and what all formats have in common.
#include "io/trajectory.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>

#include "io/dcd_reader.h"
#include "io/file_bytes.h"
#include "io/file_path.h"
#include "io/limits.h"
#include "io/netcdf_header.h"
#include "io/netcdf_reader.h"
#include "io/pdb_frames.h"
#include "io/text.h"
#include "io/trajectory_reader.h"
#include "io/trr_reader.h"
#include "io/xtc_reader.h"

namespace quickses::io {
namespace {

TrajectoryFormat find_format(const std::string &path, const ByteSource &source) {
  const std::string extension = lower_extension_of_content(path_of(path));
  if (extension == ".dcd") return TrajectoryFormat::kDcd;
  if (extension == ".xtc") return TrajectoryFormat::kXtc;
  if (extension == ".trr") return TrajectoryFormat::kTrr;
  if (extension == ".nc" || extension == ".ncdf" || extension == ".ncrst") return TrajectoryFormat::kNetcdf;
  if (extension == ".pdb" || extension == ".ent" || extension == ".brk") return TrajectoryFormat::kPdb;
  unsigned char head[256] = {};
  const size_t count = static_cast<size_t>(std::min<uint64_t>(source.size(), sizeof head));
  source.read(0, head, count);
  if (is_dcd(head, count)) return TrajectoryFormat::kDcd;
  if (is_xtc(head, count)) return TrajectoryFormat::kXtc;
  if (is_trr(head, count)) return TrajectoryFormat::kTrr;
  if (is_netcdf(head, count)) return TrajectoryFormat::kNetcdf;
  if (is_pdb(head, count)) return TrajectoryFormat::kPdb;
  fail_input("'" + path +
             "': its name and content tell no format of trajectories; known are .dcd .xtc .trr .nc .ncdf " +
             ".ncrst .pdb .ent .brk, each also as .gz");
}

std::unique_ptr<TrajectoryReader> open_reader(TrajectoryFormat format, std::unique_ptr<ByteSource> source) {
  switch (format) {
    case TrajectoryFormat::kDcd:
      return open_dcd(std::move(source));
    case TrajectoryFormat::kXtc:
      return open_xtc(std::move(source));
    case TrajectoryFormat::kPdb:
      return open_pdb_frames(std::move(source));
    case TrajectoryFormat::kTrr:
      return open_trr(std::move(source));
    case TrajectoryFormat::kNetcdf:
      return open_netcdf(std::move(source));
  }
  fail_usage("unknown format of trajectories");
}

}  // namespace

Trajectory::Trajectory(TrajectoryFormat format, std::unique_ptr<TrajectoryReader> reader)
    : format_(format), frame_count_(reader->frame_count), warnings_(reader->warnings) {
  parts_.push_back({std::move(reader), 0});
}
Trajectory::Trajectory(Trajectory &&) noexcept = default;
Trajectory &Trajectory::operator=(Trajectory &&) noexcept = default;
Trajectory::~Trajectory() = default;

Trajectory Trajectory::open(const std::string &path) {
  std::unique_ptr<ByteSource> source = ByteSource::open_file(path);
  const TrajectoryFormat format = find_format(path, *source);
  return Trajectory(format, open_reader(format, std::move(source)));
}

Trajectory Trajectory::open(const std::string &path, TrajectoryFormat format) {
  return Trajectory(format, open_reader(format, ByteSource::open_file(path)));
}

Trajectory Trajectory::open_all(const std::vector<std::string> &paths) {
  if (paths.empty()) fail_usage("there are no trajectories to be opened");
  Trajectory all = open(paths.front());
  for (size_t k = 1; k < paths.size(); ++k) {
    Trajectory next = open(paths[k]);
    if (next.atom_count() != all.atom_count())
      fail_input("'" + paths[k] + "' has " + counted(next.atom_count(), "atom") + ", but '" + paths.front() + "' has " +
                 std::to_string(all.atom_count()) + ": trajectories in a row must be of the same atoms");
    next.parts_.front().first = all.frame_count_;
    all.frame_count_ += next.frame_count_;
    all.parts_.push_back(std::move(next.parts_.front()));
    all.warnings_.insert(all.warnings_.end(), next.warnings_.begin(), next.warnings_.end());
  }
  return all;
}

Trajectory Trajectory::from_memory(std::string bytes, std::optional<TrajectoryFormat> format, const std::string &name) {
  std::unique_ptr<ByteSource> source = ByteSource::in_memory(unpack_gzip(std::move(bytes), name), name);
  const TrajectoryFormat known = format ? *format : find_format(name, *source);
  return Trajectory(known, open_reader(known, std::move(source)));
}

size_t Trajectory::atom_count() const { return parts_.front().reader->atom_count; }

bool Trajectory::incomplete() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part &part) { return part.reader->incomplete; });
}

const Trajectory::Part &Trajectory::part_of(size_t frame) const {
  if (frame >= frame_count_) {
    const size_t others = parts_.size() - 1;
    fail_usage("'" + parts_.front().reader->name() + "'" +
               (others == 0 ? " has" : " and " + std::to_string(others) + " more have") + " no frame " +
               std::to_string(frame) + ": the last is " + std::to_string(frame_count_ - 1));
  }
  const auto starts_behind = [](size_t number, const Part &part) { return number < part.first; };
  return *std::prev(std::upper_bound(parts_.begin(), parts_.end(), frame, starts_behind));
}

const std::string &Trajectory::file_of(size_t frame) const { return part_of(frame).reader->name(); }

bool Trajectory::unwrap(const uint8_t *elements) {
  std::vector<float> xyz(3 * atom_count());
  std::exception_ptr damaged;
  for (size_t frame = 0; frame < frame_count_; ++frame) {
    std::optional<Box> found;
    try {
      if (found = box(frame); !found) continue;
      read_as_it_is(frame, xyz.data());
    } catch (const Error &) {
      if (!damaged) damaged = std::current_exception();
      continue;
    }
    try {
      unwrapper_ = Unwrapper(elements, xyz.data(), atom_count(), *found);
    } catch (const Error &error) {
      const Part &part = part_of(frame);
      fail_input("'" + part.reader->name() + "': frame " + std::to_string(frame - part.first) + ": " + error.what());
    }
    return true;
  }
  if (damaged) std::rethrow_exception(damaged);
  return false;
}

bool Trajectory::read_frame(size_t frame, float *xyz) const {
  read_as_it_is(frame, xyz);
  if (!unwrapper_) return false;
  const std::optional<Box> found = box(frame);
  if (!found) return false;
  unwrapper_->apply(*found, xyz);
  check_positions(frame, xyz);  // a molecule in one piece may reach out
  return true;
}

void Trajectory::read_as_it_is(size_t frame, float *xyz) const {
  const Part &part = part_of(frame);
  part.reader->read_frame(frame - part.first, xyz);
  check_positions(frame, xyz);
}

void Trajectory::check_positions(size_t frame, const float *xyz) const {
  const Part &part = part_of(frame);
  const size_t count = 3 * atom_count();
  const float *bad = std::find_if(xyz, xyz + count, [](float x) { return !(std::abs(x) <= kFarthest); });
  if (bad == xyz + count) return;
  const size_t place = static_cast<size_t>(bad - xyz);
  fail_input("'" + part.reader->name() + "': frame " + std::to_string(frame - part.first) + ": atom " +
             std::to_string(place / 3 + 1) +
             (std::isfinite(*bad) ? " is more than 1,000,000 Å from the origin"
                                  : std::string(" has no finite ") + "xyz"[place % 3] + " coordinate"));
}

std::optional<Box> Trajectory::box(size_t frame) const {
  const Part &part = part_of(frame);
  return part.reader->box(frame - part.first);
}

std::optional<double> Trajectory::time(size_t frame) const {
  const Part &part = part_of(frame);
  return part.reader->time(frame - part.first);
}

}  // namespace quickses::io
