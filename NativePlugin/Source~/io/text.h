// SPDX-License-Identifier: MIT
// Lines, words and numbers of text files, independent of the locale.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace quickses::io {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// ASCII only, whatever the locale.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
inline char to_upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
inline char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

inline std::string raised(std::string_view text) {
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(), to_upper);
  return word;
}

inline std::string lowered(std::string_view text) {
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(), to_lower);
  return word;
}

inline bool is_one_of(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// Names in structures are printable ASCII: they must not steer a terminal, and gemmi shifts their characters as signed
// numbers.
inline char to_ascii(char c) { return c >= ' ' && c <= '~' ? c : '?'; }

inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Editors of Windows put it before a text.
inline bool has_byte_order_mark(std::string_view text) { return text.substr(0, 3) == "\xef\xbb\xbf"; }

// PowerShell writes UTF-16, with a mark before it, where its output goes to a file. What is no ASCII becomes a question
// mark, as names have no other letters.
inline void narrow_utf16(std::string &text) {
  const bool is_big = text.compare(0, 2, "\xfe\xff") == 0;
  if (!is_big && text.compare(0, 2, "\xff\xfe") != 0) return;
  size_t count = 0;
  for (size_t k = 2; k + 1 < text.size(); k += 2) {
    const char high = text[is_big ? k : k + 1], low = text[is_big ? k + 1 : k];
    text[count++] = high == 0 && static_cast<unsigned char>(low) < 0x80 ? low : '?';
  }
  text.resize(count);
}

// Of a text as editors write it: in bytes, without a mark, and with the line ends that next_line knows where it has CR
// alone.
inline void unify_text(std::string &text) {
  narrow_utf16(text);
  if (has_byte_order_mark(text)) text.erase(0, 3);
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

// Takes the first line off the text, without its end. False at the end of the text.
inline bool next_line(std::string_view &text, std::string_view &line) {
  if (text.empty()) return false;
  const size_t end = text.find('\n');
  line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

inline void split_words(std::string_view line, std::vector<std::string_view> &words) {
  words.clear();
  for (line = trim(line); !line.empty(); line = trim(line)) {
    size_t end = 0;
    while (end < line.size() && !is_blank(line[end])) ++end;
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

// The whole of the text, blanks around it aside, as a finite number.
inline bool parse_number(std::string_view text, double &value) {
  text = trim(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size() && std::isfinite(value);
}

// What is between the separators; at least one part, which may be empty.
inline std::vector<std::string> split(const std::string &text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size(); begin += parts.back().size() + 1)
    parts.push_back(text.substr(begin, text.find(separator, begin) - begin));
  return parts;
}

template <typename Integer>
bool parse_integer(std::string_view text, Integer &value) {
  text = trim(text);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

// What a message quotes of a text that a user may have made by a program: of a long one the two ends, in whole letters,
// so that what else the message says is not lost behind it.
inline std::string excerpt_of(std::string_view text) {
  constexpr size_t kMost = 200, kEnd = 90;  // bytes
  const auto continues_letter = [&](size_t k) { return (static_cast<unsigned char>(text[k]) & 0xc0) == 0x80; };
  if (text.size() <= kMost) return std::string(text);
  size_t first = kEnd, last = text.size() - kEnd;
  while (first > 0 && continues_letter(first)) --first;
  while (last < text.size() && continues_letter(last)) ++last;
  return std::string(text.substr(0, first)) + " ... " + std::string(text.substr(last));
}

// "1 atom", "2 atoms". many: where it is not the one with an s.
inline std::string counted(uint64_t count, const std::string &one, const std::string &many = "") {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

// "HEM, NAG and ZN"; of more than nine the first eight "and 3 more".
inline std::string list_of(const std::vector<std::string> &names) {
  constexpr size_t kMost = 8;
  const size_t shown = names.size() > kMost + 1 ? kMost : names.size();
  std::string list;
  for (size_t k = 0; k < shown; ++k)
    list += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + (names[k].empty() ? "''" : names[k]);
  return shown == names.size() ? list : list + " and " + std::to_string(names.size() - shown) + " more";
}

// "there is 1 atom", "there are 2 atoms"
inline std::string there_are(uint64_t count, const std::string &one, const std::string &many = "") {
  return (count == 1 ? "there is " : "there are ") + counted(count, one, many);
}

}  // namespace quickses::io
