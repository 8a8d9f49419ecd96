// SPDX-License-Identifier: MIT
// Trajectories: many frames of the same atoms. DCD (CHARMM, NAMD, X-PLOR), XTC and TRR (GROMACS), netCDF
// (AMBER), PDB with several models.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/box.h"
#include "io/unwrap.h"

namespace quickses::io {

enum class TrajectoryFormat { kDcd, kXtc, kPdb, kTrr, kNetcdf };

class TrajectoryReader;

// An open trajectory. Frames count from 0 and are read in any order. Opening walks the headers of the frames, not the
// coordinates, so damage inside of a frame shows when the frame is read.
// All const members may be called from several threads at a time; files are read by position, without a lock.
class Trajectory {
 public:
  // The format follows from the name (.dcd .xtc .trr .nc .ncdf .ncrst .pdb .ent .brk, each also with .gz
  // behind), else from the content.
  // A file that ends within a frame, or makes no sense from some frame on, gives the frames before: see incomplete().
  // Throws Error (kInput): unreadable, no such format, not one whole frame, frames of different numbers of atoms, DCD
  // with velocities.
  static Trajectory open(const std::string &path);
  static Trajectory open(const std::string &path, TrajectoryFormat format);

  // Files whose frames follow each other, numbered through; at least one. Nothing is left out where they overlap, nor
  // are times changed. Throws as open; also Error (kInput) if they have different numbers of atoms.
  static Trajectory open_all(const std::vector<std::string> &paths);

  // As open, from bytes, gzipped or not. Without a format, the name's extension tells, or the content.
  // name: also for messages.
  static Trajectory from_memory(std::string bytes, std::optional<TrajectoryFormat> format,
                                const std::string &name = "trajectory");

  Trajectory(Trajectory &&) noexcept;
  Trajectory &operator=(Trajectory &&) noexcept;
  ~Trajectory();

  TrajectoryFormat format() const { return format_; }  // of the first file
  size_t frame_count() const { return frame_count_; }  // whole frames, at least 1
  size_t atom_count() const;  // per frame, at least 1; in PDB files all ATOM and HETATM records of a model

  // The file that a frame is in. Throws Error (kUsage): no such frame.
  const std::string &file_of(size_t frame) const;

  // True if the file ends, or stops making sense, before it should: within a frame, or (DCD) before as many frames as
  // its header announces. warnings() then says what and where.
  bool incomplete() const;
  const std::vector<std::string> &warnings() const { return warnings_; }  // sentences for the user

  // From now on frames with a box have each molecule in one piece (see Unwrapper). Which atoms are bonded is taken from
  // the first frame with a box that can be read. elements: atom_count() atomic numbers, 0 = unknown; not kept.
  // False: no frame has a box, so all come as before. No other thread may use the trajectory meanwhile.
  // Throws Error (kInput), and all come as before: no frame with a box can be read, or the atoms of the first one lie
  // on top of each other.
  bool unwrap(const uint8_t *elements);
  bool is_unwrapped() const { return unwrapper_.has_value(); }

  // The positions of a frame in Å: atom_count() x 3 numbers, all finite and within 1e6 Å of the origin per axis.
  // True: molecules are in one piece; false: unwrap() was not called, or this frame has no box.
  // Throws Error: kUsage (no such frame), kInput (the frame is damaged; what xyz holds is then undefined). What is said
  // of a damaged frame names its file, and counts from 0 in there.
  bool read_frame(size_t frame, float *xyz) const;

  // The periodic box of a frame, if it has one. Throws as read_frame.
  std::optional<Box> box(size_t frame) const;

  // The time of a frame in ps, if the file tells. Throws as read_frame.
  std::optional<double> time(size_t frame) const;

 private:
  // A file, and the number of its first frame.
  struct Part {
    std::unique_ptr<TrajectoryReader> reader;
    size_t first = 0;
  };

  Trajectory(TrajectoryFormat format, std::unique_ptr<TrajectoryReader> reader);
  const Part &part_of(size_t frame) const;
  void read_as_it_is(size_t frame, float *xyz) const;
  void check_positions(size_t frame, const float *xyz) const;

  TrajectoryFormat format_;
  std::vector<Part> parts_;
  size_t frame_count_ = 0;
  std::vector<std::string> warnings_;
  std::optional<Unwrapper> unwrapper_;
};

}  // namespace quickses::io
