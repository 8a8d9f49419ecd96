// SPDX-License-Identifier: MIT
// AMBER's trajectories and restart files in netCDF's classic format, after the AMBER NetCDF Trajectory/Restart
// Convention 1.0: coordinates(frame, atom, spatial), time(frame), cell_lengths(frame, 3), cell_angles(frame, 3);
// restart files are one frame without that dimension. Å, ps, degrees.
#include "io/netcdf_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/big_endian.h"
#include "io/netcdf_header.h"
#include "io/text.h"

namespace quickses::io {
namespace {

constexpr uint64_t kMaxAtoms = 0x7fffffff;

// Values of a variable, frame by frame.
struct Series {
  uint64_t begin = 0;
  uint64_t stride = 0;  // from one frame to the next
  uint64_t size = 0;    // bytes of a frame
  size_t number_size = 0;
  double factor = 1;

  uint64_t at(size_t frame) const { return begin + frame * stride; }
  // Frames whose bytes are all there; of a single one no more than that.
  uint64_t frames_within(uint64_t file_size) const {
    if (begin > file_size || size > file_size - begin) return 0;
    return stride == 0 ? 1 : 1 + (file_size - begin - size) / stride;
  }
};

bool starts_with(const std::string &text, const char *start) {
  const size_t size = std::strlen(start);
  return text.size() >= size &&
         std::equal(start, start + size, text.begin(), [](char a, char b) { return a == to_lower(b); });
}

class NetcdfReader : public TrajectoryReader {
 public:
  explicit NetcdfReader(std::unique_ptr<ByteSource> source)
      : TrajectoryReader(source->name()), source_(std::move(source)) {
    refuse_hdf5();
    const NetcdfHeader header = read_netcdf_header(*source_);
    find_coordinates(header);
    time_ = find_series(header, "time", {});
    if (const NetcdfVariable *time = header.find("time"); time && !time->units.empty())
      if (!starts_with(time->units, "pico") && !starts_with(time->units, "ps")) time_.reset();
    lengths_ = find_series(header, "cell_lengths", {3});
    angles_ = find_series(header, "cell_angles", {3});
    count_frames(header);
  }

  void read_frame(size_t frame, float *xyz) const override {
    read_big_endian(*source_, coordinates_.at(frame), coordinates_.number_size, coordinates_.factor, xyz,
                    3 * atom_count);
  }

  std::optional<Box> box(size_t frame) const override {
    if (!lengths_ || !angles_) return std::nullopt;
    double edges[3], angles[3];
    read_numbers(*lengths_, frame, edges, 3);
    read_numbers(*angles_, frame, angles, 3);
    return box_from_edges(edges[0], edges[1], edges[2], angles[0], angles[1], angles[2]);
  }

  std::optional<double> time(size_t frame) const override {
    if (!time_) return std::nullopt;
    double time;
    read_numbers(*time_, frame, &time, 1);
    if (!std::isfinite(time)) return std::nullopt;
    return time;
  }

 private:
  void refuse_hdf5() const {
    unsigned char magic[4] = {};
    source_->read(0, magic, static_cast<size_t>(std::min<uint64_t>(source_->size(), sizeof magic)));
    if (std::memcmp(magic, "\x89HDF", 4) == 0)
      fail(
          "this is a netCDF-4 file (HDF5), and only classic netCDF files are read; nccopy -k 64-bit-offset makes one "
          "of it");
  }

  void read_numbers(const Series &series, size_t frame, double *numbers, size_t count) const {
    unsigned char bytes[24];
    source_->read(series.at(frame), bytes, count * series.number_size);
    for (size_t i = 0; i < count; ++i)
      numbers[i] = series.factor * big_endian_float(bytes + i * series.number_size, series.number_size);
  }

  // What makes the file a trajectory: how many atoms, and where frames are.
  void find_coordinates(const NetcdfHeader &header) {
    const NetcdfVariable *variable = header.find("coordinates");
    if (!variable) fail("it has no variable 'coordinates', as the trajectories of AMBER have");
    const size_t rank = variable->lengths.size();
    is_fixed_ = !variable->has_records && rank == 3;
    is_single_ = !variable->has_records && rank == 2;
    if (rank != (is_fixed_ ? 3u : 2u) || variable->lengths.back() != 3)
      fail("its variable 'coordinates' has other dimensions than frame, atom and spatial (3)");
    if (variable->type != NetcdfType::kFloat && variable->type != NetcdfType::kDouble)
      fail("its variable 'coordinates' is neither float nor double");
    const std::string &units = variable->units;
    if (!units.empty() && !starts_with(units, "angstrom") && units != "A" && units != "Å")
      fail("its coordinates are in '" + units + "', not in angstrom");
    const uint64_t atoms = variable->lengths[rank - 2];
    if (atoms > kMaxAtoms) fail("its number of atoms, " + std::to_string(atoms) + ", makes no sense");
    atom_count = static_cast<size_t>(atoms);
    if (is_fixed_) fixed_count_ = variable->lengths[0];
    coordinates_ = *find_series(header, "coordinates", {atoms, 3});
  }

  // Nothing if there is no such variable, or none of floating-point numbers with these lengths in each frame. Some give
  // a single number a dimension of its own.
  std::optional<Series> find_series(const NetcdfHeader &header, const char *name, std::vector<uint64_t> lengths) const {
    const NetcdfVariable *variable = header.find(name);
    if (!variable || (variable->type != NetcdfType::kFloat && variable->type != NetcdfType::kDouble))
      return std::nullopt;
    const size_t number_size = variable->type == NetcdfType::kDouble ? 8 : 4;
    if (is_fixed_) lengths.insert(lengths.begin(), fixed_count_);
    if (variable->has_records != (!is_fixed_ && !is_single_) ||
        (variable->lengths != lengths && !(lengths.empty() && variable->size == number_size)))
      return std::nullopt;
    Series series;
    series.begin = variable->begin;
    series.size = is_fixed_ ? variable->size / fixed_count_ : variable->size;
    series.stride = is_single_ ? 0 : is_fixed_ ? series.size : header.record_size;
    series.number_size = number_size;
    series.factor = variable->scale_factor;
    return series;
  }

  void count_frames(const NetcdfHeader &header) {
    uint64_t whole = coordinates_.frames_within(source_->size());
    for (const std::optional<Series> &series : {time_, lengths_, angles_})
      if (series) whole = std::min(whole, series->frames_within(source_->size()));
    const bool is_open = !is_fixed_ && !is_single_ && !header.record_count;
    if (!is_open) {
      const uint64_t announced = is_single_ ? 1 : is_fixed_ ? fixed_count_ : *header.record_count;
      if (announced == 0) fail("it has no frames");
      frame_count = static_cast<size_t>(std::min(whole, announced));
      if (whole < announced) end_at(frame_count, "is cut off");
      return;
    }
    frame_count = static_cast<size_t>(whole);
    uint64_t begin = coordinates_.begin;  // of the first record
    for (const NetcdfVariable &variable : header.variables)
      if (variable.has_records) begin = std::min(begin, variable.begin);
    if (source_->size() > begin + whole * header.record_size) end_at(frame_count, "is cut off");
    if (frame_count == 0) fail("it has no frames");
  }

  std::unique_ptr<ByteSource> source_;
  bool is_fixed_ = false;     // the number of frames is in the header
  bool is_single_ = false;    // a restart file
  uint64_t fixed_count_ = 0;  // that number
  Series coordinates_;
  std::optional<Series> time_, lengths_, angles_;
};

}  // namespace

std::unique_ptr<TrajectoryReader> open_netcdf(std::unique_ptr<ByteSource> source) {
  return std::make_unique<NetcdfReader>(std::move(source));
}

}  // namespace quickses::io
