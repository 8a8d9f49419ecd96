// SPDX-License-Identifier: MIT
// Counts that nobody waits for. Where a stage counts on the device what the host needs to know (how many bricks there
// are, how many vertices), reading that back would leave the device without work. A frame that is like the one before
// goes on with what was counted then and some more; later one look at all the counts tells whether that was enough. If
// it was not, the frame is done again, and waits for each.
//
// A type of counts has two members: anticipated(last, most), how many there may be if there were `last` in the frame
// before, and at most `most`; and covers(found), whether that is enough for what was found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace quickses {

// Thrown where a frame was done with too little room: the same is to be done again. What is known of it is forgotten.
struct AnticipatedTooLittle {};

// So many, and what may be more in the next frame of a trajectory.
template <class T>
constexpr T and_some_more(T n) {
  return n + n / 16 + 64;
}

// A single number. T: uint32_t or uint64_t. kUntold: up to so many are told as 0.
template <class T, T kUntold = 0>
struct Tally {
  T count;
  static Tally anticipated(const Tally &last, const Tally &most) {
    return {std::min(std::max(and_some_more(last.count), kUntold), most.count)};
  }
  bool covers(const Tally &found) const { return found.count <= count; }
};

// What was counted in the last frame, by page (a number: the level's; 0: of what levels share; and that of a part of
// it, or 0) and name; and what this one relies on.
class Anticipation {
 public:
  // Frames of one kind follow each other; another kind is not like those before. 0: nothing is anticipated, or noted.
  void open(uint64_t kind) {
    is_open_ = kind != 0;
    has_anticipated_ = false;
    relied_on_.clear();
    counting_ = 0;
    if (!is_open_) return;
    if (kind != kind_) pages_.clear();
    kind_ = kind;
    page_ = {};
    for (Page &page : pages_)
      for (Entry &entry : page.entries) entry.is_new = false;
    waiting_frames_ = waiting_frames_ > 0 ? waiting_frames_ - 1 : 0;
    if (was_enough_ && too_little_ > 0) --too_little_;
    was_enough_ = false;
  }
  bool is_open() const { return is_open_; }
  // Of frames of this kind.
  bool knows_frames() const { return !pages_.empty(); }
  void forget_frames() { pages_.clear(); }
  // Whether this frame went on with a count from the one before.
  bool has_anticipated() const { return has_anticipated_; }
  void turn_to(float level, uint32_t part = 0) { page_ = {level, part}; }

  // False: whoever asks has to wait, and note() what there is.
  template <class T>
  bool anticipate(const char *name, size_t place, const T &most, T *expected) {
    if (!foresee(name, most, expected)) return false;
    has_anticipated_ = true;
    relied_on_.push_back({page_, place, Entry(name, *expected), &is_covered<T>, is_aside_});
    return true;
  }
  // This frame does not go on with it: where it counts anew, what it had counted was with too little room.
  template <class T>
  void note(const char *name, const T &found) {
    Entry entry(name, found);
    entry.is_new = true;
    note(page_, entry);
  }
  // What would be anticipated now, if anything is.
  template <class T>
  bool foresee(const char *name, const T &most, T *expected) const {
    const Entry *const last = is_open_ && waiting_frames_ == 0 ? find(name) : nullptr;
    if (!last || last->is_new) return false;
    *expected = T::anticipated(last->as<T>(), most);
    return true;
  }

  // Of which it was not told yet that it is being counted.
  bool relies_on_something() const { return relied_on_.size() > counting_; }
  // What is relied on by now is about to be counted, but what is counted aside.
  void note_counting() {
    counting_ = static_cast<size_t>(
        std::stable_partition(relied_on_.begin(), relied_on_.end(), [](const Reliance &r) { return !r.is_aside; }) -
        relied_on_.begin());
  }
  // What is relied on from now on is counted aside, until both come together again.
  void turn_aside(bool is_aside) { is_aside_ = is_aside; }
  void join() {
    for (Reliance &r : relied_on_) r.is_aside = false;
  }
  // counted: where the counts are whose places were given. Throws AnticipatedTooLittle.
  void verify(const unsigned char *counted) {
    bool enough = true;
    const auto end = relied_on_.begin() + static_cast<std::ptrdiff_t>(counting_);
    for (auto relied = relied_on_.begin(); relied != end; ++relied) {
      const Reliance &r = *relied;
      enough &= r.is_covered(counted + r.place, r.expected.bytes);
      Entry found = r.expected;
      std::memcpy(found.bytes, counted + r.place, found.size);
      note(r.page, found);
    }
    relied_on_.erase(relied_on_.begin(), end);
    counting_ = 0;
    was_enough_ = enough;
    if (enough) return;
    // Counts that come after one that was not enough mean nothing. Frames that are unlike each other rather wait.
    pages_.clear();
    too_little_ = std::min(too_little_ + 1, 6u);
    waiting_frames_ = 1u << too_little_;
    throw AnticipatedTooLittle{};
  }

  static constexpr size_t kMostBytes = 64;  // of one type of counts

 private:
  struct Entry {
    const char *name;
    size_t size;          // of the counts
    bool is_new = false;  // of this frame
    alignas(8) unsigned char bytes[kMostBytes] = {};
    template <class T>
    Entry(const char *entry, const T &value) : name(entry), size(sizeof value) {
      static_assert(sizeof(T) <= kMostBytes, "counts are few");
      std::memcpy(bytes, &value, sizeof value);
    }
    template <class T>
    T as() const {
      T value;
      std::memcpy(&value, bytes, sizeof value);
      return value;
    }
  };
  struct Number {
    float level;
    uint32_t part;
    bool operator==(const Number &other) const { return level == other.level && part == other.part; }
  };
  struct Page {
    Number number;
    std::vector<Entry> entries;
  };
  struct Reliance {
    Number page;
    size_t place;
    Entry expected;
    bool (*is_covered)(const unsigned char *found, const unsigned char *expected);
    bool is_aside;
  };

  template <class T>
  static bool is_covered(const unsigned char *found, const unsigned char *expected) {
    T f, e;
    std::memcpy(&f, found, sizeof f);
    std::memcpy(&e, expected, sizeof e);
    return e.covers(f);
  }
  static constexpr size_t kMostPages = 1024;  // a ladder may have 900, with all steps of relaxation
  const Entry *find(const char *name) const {
    for (const Page &page : pages_)
      if (page.number == page_)
        for (const Entry &entry : page.entries)
          if (std::strcmp(entry.name, name) == 0) return &entry;
    return nullptr;
  }
  void note(const Number &number, const Entry &found) {
    auto page = std::find_if(pages_.begin(), pages_.end(), [&](const Page &p) { return p.number == number; });
    if (page == pages_.end()) {
      if (pages_.size() == kMostPages) pages_.erase(pages_.begin());  // noted longest ago
      page = pages_.insert(pages_.end(), Page{number, {}});
    } else {
      std::rotate(page, page + 1, pages_.end());
      page = pages_.end() - 1;
    }
    for (Entry &entry : page->entries)
      if (std::strcmp(entry.name, found.name) == 0) {
        entry = found;
        return;
      }
    page->entries.push_back(found);
  }

  bool is_open_ = false, has_anticipated_ = false, is_aside_ = false;
  uint64_t kind_ = 0;
  Number page_{};
  std::vector<Page> pages_;
  std::vector<Reliance> relied_on_;
  size_t counting_ = 0;      // the first so many
  bool was_enough_ = false;  // in this frame
  unsigned too_little_ = 0;  // lately
  unsigned waiting_frames_ = 0;
};

}  // namespace quickses
