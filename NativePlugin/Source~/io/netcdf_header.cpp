// SPDX-License-Identifier: MIT
// The header of a file in netCDF's classic format: the grammar in appendix B of the NetCDF User's Guide. All numbers
// are big-endian and in units of 4 bytes; lists of dimensions, attributes of the file, and variables follow each other.
#include "io/netcdf_header.h"

#include <algorithm>
#include <cstring>

#include "io/big_endian.h"
#include "io/error.h"

namespace quickses::io {
namespace {

constexpr uint32_t kDimensionTag = 10, kVariableTag = 11, kAttributeTag = 12;
constexpr uint64_t kMaxNameSize = 1024;            // the library allows 256
constexpr uint64_t kMaxBytes = uint64_t{1} << 60;  // of a variable; keeps sums within 64 bits
constexpr size_t kMaxVariables = 8192;             // the library's limit
constexpr size_t kMaxRank = 1024;                  // the same

uint64_t size_of(NetcdfType type) {
  switch (type) {
    case NetcdfType::kByte:
    case NetcdfType::kChar:
    case NetcdfType::kUnsignedByte:
      return 1;
    case NetcdfType::kShort:
    case NetcdfType::kUnsignedShort:
      return 2;
    case NetcdfType::kInt:
    case NetcdfType::kFloat:
    case NetcdfType::kUnsignedInt:
      return 4;
    case NetcdfType::kDouble:
    case NetcdfType::kInt64:
    case NetcdfType::kUnsignedInt64:
      return 8;
  }
  return 0;
}

uint64_t filled_up(uint64_t size) { return (size + 3) / 4 * 4; }

class HeaderReader {
 public:
  explicit HeaderReader(const ByteSource &source) : source_(source) {}

  NetcdfHeader read() {
    unsigned char magic[4];
    take(magic, 4);
    version_ = magic[3];
    if (std::memcmp(magic, "CDF", 3) != 0 || (version_ != 1 && version_ != 2 && version_ != 5))
      fail("it is no netCDF file in the classic format (CDF-1, CDF-2 or CDF-5)");
    NetcdfHeader header;
    const uint64_t record_count = count();
    if (record_count != (version_ == 5 ? UINT64_MAX : uint64_t{UINT32_MAX})) header.record_count = record_count;
    for (uint64_t left = list(kDimensionTag); left != 0; --left) {
      name();
      dimensions_.push_back(count());
    }
    for (uint64_t left = list(kAttributeTag); left != 0; --left) attribute(nullptr);
    for (uint64_t left = list(kVariableTag); left != 0; --left) {
      if (header.variables.size() == kMaxVariables) fail_damaged();
      header.variables.push_back(variable());
    }
    header.record_size = record_size(header.variables);
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string &what) const { fail_input("'" + source_.name() + "': " + what); }
  [[noreturn]] void fail_damaged() const { fail("its header is damaged"); }

  void check_left(uint64_t size) const {
    if (size > source_.size() - at_) fail("it is cut off within its header");
  }

  void take(unsigned char *bytes, size_t size) {
    check_left(size);
    source_.read(at_, bytes, size);
    at_ += size;
  }

  void skip(uint64_t size) {
    check_left(size);
    at_ += size;
  }

  uint32_t u32() {
    unsigned char bytes[4];
    take(bytes, 4);
    return big_endian_u32(bytes);
  }

  uint64_t u64() {
    unsigned char bytes[8];
    take(bytes, 8);
    return big_endian_u64(bytes);
  }

  uint64_t count() { return version_ == 5 ? u64() : u32(); }
  uint64_t offset() { return version_ == 1 ? u32() : u64(); }

  // How many entries a list has. One without any says so by a tag of 0.
  uint64_t list(uint32_t tag) {
    const uint32_t found = u32();
    const uint64_t size = count();
    if (found != tag && !(found == 0 && size == 0)) fail_damaged();
    return size;
  }

  // Names have at least one letter: a list that is said to be endless ends where there are zeros.
  std::string name() {
    const uint64_t size = count();
    if (size == 0 || size > kMaxNameSize) fail_damaged();
    return text(size);
  }

  std::string text(uint64_t size) {
    check_left(filled_up(size));
    std::string text(static_cast<size_t>(size), '\0');
    source_.read(at_, &text[0], text.size());
    at_ += filled_up(size);
    return text;
  }

  NetcdfType type() {
    const uint32_t type = u32();
    if (type < 1 || type > (version_ == 5 ? 11u : 6u)) fail_damaged();
    return static_cast<NetcdfType>(type);
  }

  // variable: nullptr for attributes of the file.
  void attribute(NetcdfVariable *variable) {
    const std::string attribute_name = name();
    const NetcdfType attribute_type = type();
    const uint64_t length = count();
    if (length > kMaxBytes) fail_damaged();
    const uint64_t size = filled_up(length * size_of(attribute_type));
    if (variable && attribute_name == "units" && attribute_type == NetcdfType::kChar && length <= kMaxNameSize) {
      variable->units = text(length);
    } else if (variable && attribute_name == "scale_factor" && length == 1 &&
               (attribute_type == NetcdfType::kFloat || attribute_type == NetcdfType::kDouble)) {
      unsigned char bytes[8];
      take(bytes, static_cast<size_t>(size));
      variable->scale_factor = big_endian_float(bytes, static_cast<size_t>(size));
    } else {
      skip(size);
    }
  }

  NetcdfVariable variable() {
    NetcdfVariable variable;
    variable.name = name();
    const uint64_t rank = count();
    if (rank > kMaxRank) fail_damaged();
    uint64_t values = 1;
    for (uint64_t k = 0; k < rank; ++k) {
      const uint64_t id = count();
      if (id >= dimensions_.size()) fail_damaged();
      const uint64_t length = dimensions_[static_cast<size_t>(id)];
      if (length == 0) {  // the record dimension
        if (k != 0) fail_damaged();
        variable.has_records = true;
        continue;
      }
      if (length > kMaxBytes / values) fail_damaged();
      values *= length;
      variable.lengths.push_back(length);
    }
    for (uint64_t left = list(kAttributeTag); left != 0; --left) attribute(&variable);
    variable.type = type();
    variable.size = values * size_of(variable.type);
    if (variable.size > kMaxBytes) fail_damaged();
    count();  // its size once more, which large variables of small formats can't say
    variable.begin = offset();
    if (variable.begin > kMaxBytes) fail_damaged();
    return variable;
  }

  // Pieces of a record are filled up to units of 4 bytes. A single variable of a small type would lie without gaps,
  // but here one of floating-point numbers is among them.
  uint64_t record_size(const std::vector<NetcdfVariable> &variables) const {
    uint64_t sum = 0;
    for (const NetcdfVariable &variable : variables) {
      if (variable.has_records) sum += filled_up(variable.size);
      if (sum > kMaxBytes) fail_damaged();
    }
    return sum;
  }

  const ByteSource &source_;
  uint64_t at_ = 0;
  unsigned version_ = 0;
  std::vector<uint64_t> dimensions_;
};

}  // namespace

const NetcdfVariable *NetcdfHeader::find(const std::string &name) const {
  const auto found = std::find_if(variables.begin(), variables.end(),
                                  [&](const NetcdfVariable &variable) { return variable.name == name; });
  return found == variables.end() ? nullptr : &*found;
}

NetcdfHeader read_netcdf_header(const ByteSource &source) { return HeaderReader(source).read(); }

bool is_netcdf(const unsigned char *head, size_t size) {
  return size >= 4 && std::memcmp(head, "CDF", 3) == 0 && (head[3] == 1 || head[3] == 2 || head[3] == 5);
}

}  // namespace quickses::io
