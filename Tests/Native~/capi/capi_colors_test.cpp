// SPDX-License-Identifier: MIT
// The C API: colours of a structure's atoms.
#include "capi/capi_fixture.h"

#include <string>
#include <vector>

namespace {

using namespace capi_fixture;

const char kPdb[] =
    "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00 10.00           N\n"
    "ATOM      2  O   ASP B   2       5.000   2.000   3.000  1.00 20.00           O\n"
    "HETATM    3  O   HOH     3      11.000   2.000  -3.500  1.00 60.00           O\n"
    "END\n";
const uint8_t kUniform[4] = {1, 2, 3, 4};

struct CloseStructure {
  void operator()(qses_structure *structure) const { qses_structure_close(structure); }
};
using StructurePointer = std::unique_ptr<qses_structure, CloseStructure>;

StructurePointer open_text() {
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.format = QSES_STRUCTURE_PDB;
  qses_structure *structure = nullptr;
  expect_ok(qses_structure_open_memory(kPdb, sizeof kPdb - 1, &options, &structure));
  return StructurePointer(structure);
}

using Bytes = std::vector<uint8_t>;

TEST(Colors, OfEachScheme) {
  const StructurePointer structure = open_text();
  std::vector<Bytes> of_scheme;
  for (int scheme = QSES_COLOR_UNIFORM; scheme <= QSES_COLOR_SEQUENCE; ++scheme) {
    Bytes rgba(4 * 3 + 1, 77);
    expect_ok(qses_structure_colors(structure.get(), static_cast<qses_color_scheme>(scheme), kUniform, rgba.data(), 3));
    EXPECT_EQ(rgba.back(), 77);
    if (scheme != QSES_COLOR_ELEMENT) {  // no chain, no residue that is known
      EXPECT_EQ(Bytes(rgba.begin() + 8, rgba.begin() + 12), Bytes(kUniform, kUniform + 4)) << scheme;
    }
    if (scheme != QSES_COLOR_UNIFORM) {
      EXPECT_EQ(rgba[3], 255);
    }
    for (const Bytes &other : of_scheme) EXPECT_NE(rgba, other) << scheme;
    of_scheme.push_back(rgba);
  }
  EXPECT_EQ(Bytes(of_scheme[0].begin(), of_scheme[0].begin() + 4), Bytes(kUniform, kUniform + 4));
  EXPECT_EQ(Bytes(of_scheme[1].begin() + 4, of_scheme[1].begin() + 8), (Bytes{0xFF, 0x0D, 0x0D, 0xFF}));
}

TEST(Colors, Errors) {
  const StructurePointer structure = open_text();
  Bytes rgba(12, 77);
  const auto refused = [&](qses_status status, std::initializer_list<const char *> words) {
    expect_error(status, QSES_INVALID_ARGUMENT, words);
    EXPECT_EQ(rgba, Bytes(12, 77));
  };
  refused(qses_structure_colors(nullptr, QSES_COLOR_CHAIN, kUniform, rgba.data(), 3), {"structure", "NULL"});
  refused(qses_structure_colors(structure.get(), QSES_COLOR_CHAIN, nullptr, rgba.data(), 3), {"uniform_rgba", "NULL"});
  refused(qses_structure_colors(structure.get(), QSES_COLOR_CHAIN, kUniform, nullptr, 3), {"rgba", "NULL"});
  refused(qses_structure_colors(structure.get(), QSES_COLOR_CHAIN, kUniform, rgba.data(), 2),
          {"count is 2", "3 atoms"});
  for (const int scheme : {-1, 6})
    refused(qses_structure_colors(structure.get(), static_cast<qses_color_scheme>(scheme), kUniform, rgba.data(), 3),
            {"scheme", std::to_string(scheme).c_str()});
}

}  // namespace
