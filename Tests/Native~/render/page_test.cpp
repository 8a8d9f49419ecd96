// SPDX-License-Identifier: MIT
// How large pages may become. What is in them is looked at by cli_picture_test.py and page_browser_test.py.
#include "render/page.h"

#include "io/io_fixture.h"

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

TEST_F(PageTest, HoldsWhatItMay) {
  const std::string mesh(100'000, 'x');
  Page page(path("a.html"), {}, empty_size_ + 3 * mesh.size());
  for (int frame = 0; frame < 3; ++frame) page.add(mesh);
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
      for (int frame = 0; frame < 2; ++frame) page.add(mesh);
      page.finish();
    });
    EXPECT_HAS(message, "more than " + std::to_string(most / 1'000'000) + " MB");
    EXPECT_HAS(message, "--spacing");
    EXPECT_EQ(io::slurp(path("a.html")), "old");
    EXPECT_EQ(file_count(), 1u);
  }
}

}  // namespace
}  // namespace quickses::render
