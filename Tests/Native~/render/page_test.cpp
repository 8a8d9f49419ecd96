// SPDX-License-Identifier: MIT
// How large pages may become, and the form of pictures. What is in them is looked at by cli_picture_test.py and
// page_browser_test.py.
#include "render/page.h"

#include "io/io_fixture.h"
#include "render/picture.h"

namespace quickses::render {
namespace {

using io::contains;

class PageTest : public io::IoTest {
 protected:
  void SetUp() override {
    io::IoTest::SetUp();
    try {
      check_pages_can_be_made();
    } catch (const io::Error &error) {
      GTEST_SKIP() << error.what();
    }
    Page empty(path("empty.html"), {});
    empty.finish();
    empty_size_ = empty.size();
    std::filesystem::remove(path("empty.html"));
  }
  uint64_t empty_size_ = 0;
};

using PictureFileTest = io::IoTest;

TEST_F(PageTest, HoldsWhatItMay) {
  const std::string mesh(100'000, 'x');
  Page page(path("a.html"), {}, empty_size_ + 3 * mesh.size());
  for (int frame = 0; frame < 3; ++frame) page.add(mesh, 2 - frame);
  page.finish();
  EXPECT_EQ(page.size(), empty_size_ + 3 * mesh.size());
  EXPECT_EQ(io::slurp(path("a.html")).size(), page.size());
}

// With a byte more, the last frame or the end does not fit: what was there before is left.
TEST_F(PageTest, IsNotThereIfItWouldBeTooLarge) {
  write("a.html", "old");
  const std::string mesh(2'000'001, 'x');
  for (const uint64_t most : {empty_size_ + 2 * mesh.size() - 1, empty_size_ + mesh.size() - 1, empty_size_ / 2}) {
    const std::string message = io::error_of(io::ErrorKind::kOutput, [&] {
      Page page(path("a.html"), {}, most);
      for (int frame = 0; frame < 2; ++frame) page.add(mesh, 0);  // which frames come is not known
      page.finish();
    });
    EXPECT_HAS(message, "more than " + std::to_string(most / 1'000'000) + " MB");
    EXPECT_HAS(message, "--spacing");
    EXPECT_EQ(io::slurp(path("a.html")), "old");
    EXPECT_EQ(file_count(), 1u);
  }
}

// As soon as it is clear, and not for what may still fit.
TEST_F(PageTest, TellsFromTheFirstHowManyFit) {
  const std::string mesh(1'000'000, 'x');
  const uint64_t most = empty_size_ + 10 * mesh.size();
  Page full(path("full.html"), {}, most), larger(path("larger.html"), {}, most), few(path("few.html"), {}, most);
  full.add(mesh, 9);
  larger.add(mesh, 10);  // a tenth more: the others may be smaller
  const std::string message = io::error_of(io::ErrorKind::kOutput, [&] { few.add(mesh, 11); });
  EXPECT_HAS(message, "about 10 of its 12 surfaces fit");
  EXPECT_HAS(message, "more than " + std::to_string(most / 1'000'000) + " MB");
  // Later ones may tell it, too.
  const std::string larger_mesh(2'000'000, 'x');
  EXPECT_HAS(io::error_of(io::ErrorKind::kOutput, [&] { larger.add(larger_mesh, 9); }),
             "about 5 of its 11 surfaces fit");
}

// One pixel that lets something through is enough, wherever it is.
TEST_F(PictureFileTest, HasAlphaWhereItIsNeeded) {
  for (size_t open = 0; open <= 4; ++open) {
    Image image{2, 2, std::vector<uint8_t>(16, 255)};
    if (open < 4) image.rgba[4 * open + 3] = 254;
    write_png(path("a.png"), image);
    constexpr size_t kColorType = 25;
    EXPECT_EQ(io::slurp(path("a.png")).at(kColorType), open < 4 ? 6 : 2) << open;
  }
}

}  // namespace
}  // namespace quickses::render
