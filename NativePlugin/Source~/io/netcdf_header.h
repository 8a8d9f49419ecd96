// SPDX-License-Identifier: MIT
// The header of a file in netCDF's classic format, and where the values of its variables lie.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/byte_source.h"

namespace quickses::io {

// The format's own numbers.
enum class NetcdfType : uint32_t {
  kByte = 1,
  kChar = 2,
  kShort = 3,
  kInt = 4,
  kFloat = 5,
  kDouble = 6,
  kUnsignedByte = 7,  // from here on in CDF-5 only
  kUnsignedShort = 8,
  kUnsignedInt = 9,
  kInt64 = 10,
  kUnsignedInt64 = 11
};

// A variable. Its values lie in one piece or, if its first dimension is the record dimension, in one piece per record.
struct NetcdfVariable {
  std::string name;
  std::vector<uint64_t> lengths;  // of its dimensions, without the record dimension
  bool has_records = false;
  NetcdfType type = NetcdfType::kByte;
  uint64_t begin = 0;  // of the first piece
  uint64_t size = 0;   // bytes of a piece, without what fills up the last unit of 4

  // Of its attributes, those that are asked for here.
  double scale_factor = 1;
  std::string units;
};

struct NetcdfHeader {
  std::vector<NetcdfVariable> variables;
  std::optional<uint64_t> record_count;  // nothing: the writer left it open, so the size of the file tells
  uint64_t record_size =
      0;  // from one record of all variables to the next, if one of them is of floating-point numbers

  const NetcdfVariable *find(const std::string &name) const;
};

// Classic files (CDF-1), those with 64-bit offsets (CDF-2) and with 64-bit sizes (CDF-5). That values are there is not
// checked. Throws Error (kInput), naming the source: no such file, cut off, damaged.
NetcdfHeader read_netcdf_header(const ByteSource &source);

// Whether a file starts like one. size may be less than the file has.
bool is_netcdf(const unsigned char *head, size_t size);

}  // namespace quickses::io
