// SPDX-License-Identifier: MIT
// What is taken for a structure by its name and content, and what is not.
#include "io/io_fixture.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

const char kAtom[] = "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n";

class StructureFormatTest : public IoTest {
 protected:
  std::string error_of_file(const std::string &name, const std::string &content) const {
    return error_of(ErrorKind::kInput, [&] { read_structure(write(name, content)); });
  }
};

TEST_F(StructureFormatTest, WebPagesAreNamedAsSuch) {
  for (const char *page : {"<!DOCTYPE html>\n<html><body>Not found</body></html>", "<html lang=\"en\">", "\r\n  <HTML>",
                           "\xef\xbb\xbf<!doctype HTML>", "<?xml version=\"1.0\"?>\n<!DOCTYPE html>"})
    for (const char *name : {"a.pdb", "a.cif", "a.pqr", "a.xyzr", "a.gro", "a"})
      EXPECT_HAS(error_of_file(name, page), std::string(name) + "' looks like a web page");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { read_structure(write_gz("a.cif.gz", "<html></html>")); }), "web page");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse_structure("<html>", StructureFormat::kPdb); }), "web page");
  // Other files that begin so are none, nor do files that have one behind their atoms matter.
  EXPECT_EQ(error_of_file("a.pdb", "<svg></svg>\n").find("web page"), std::string::npos);
  EXPECT_EQ(read_structure(write("b.pdb", kAtom + std::string("REMARK <html>\n"))).models[0].atoms.size(), 1u);
}

TEST_F(StructureFormatTest, BinaryFormatsSayWhatIsReadInstead) {
  for (const char *name : {"1crn.bcif", "1CRN.BCIF", "1crn.bcif.gz", "1crn.mmtf"}) {
    const std::string file =
        std::string(name).find(".gz") != std::string::npos ? write_gz(name, "\x83\xa7") : write(name, "\x83\xa7");
    const std::string message = error_of(ErrorKind::kInput, [&] { read_structure(file); });
    EXPECT_HAS(message, std::string(name));
    EXPECT_HAS(message, "files are not read; the mmCIF file of the same entry");
  }
}

TEST_F(StructureFormatTest, AFormatThatIsGivenHolds) {
  EXPECT_EQ(read_structure(write("a.cif", kAtom), StructureFormat::kPdb, {}).models[0].atoms.size(), 1u);
  EXPECT_HAS(error_of_file("a.txt", "1 2 3 1.5\n"), "of others the format has to be given");
  EXPECT_EQ(read_structure(write("a.txt", "1 2 3 1.5\n"), StructureFormat::kXyzr, {}).models[0].atoms.size(), 1u);
}

}  // namespace
}  // namespace quickses::io
