// SPDX-License-Identifier: MIT
// Words are parsed by recursive descent:
//   either  = both {or both}
//   both    = operand {and operand}
//   operand = not operand | within D of operand | same residue as operand | (either) | word | word names | CID
// What was CID before there were words stays CID: it has no blanks but behind a semicolon.
#include "io/selection_parser.h"

#include <algorithm>
#include <climits>
#include <new>
#include <string_view>

#include "io/elements.h"
#include "io/error.h"
#include "io/nearest_word.h"
#include "io/text.h"

namespace quickses::io {
namespace {

using Kind = SelectionTerm::Kind;

constexpr int kDeepest = 50;              // terms in each other; 64 KiB of stack do for twice as many
constexpr double kLargestDistance = 1e6;  // Å

struct KnownWord {
  std::string_view text;
  Kind kind;
};

constexpr KnownWord kPlainWords[] = {
    {"all", Kind::kAll},         {"none", Kind::kNone},         {"protein", Kind::kProtein},
    {"nucleic", Kind::kNucleic}, {"ligand", Kind::kLigand},     {"ions", Kind::kIons},
    {"water", Kind::kWater},     {"solvent", Kind::kWater},     {"hydrogen", Kind::kHydrogen},
    {"hetero", Kind::kHetero},   {"backbone", Kind::kBackbone}, {"sidechain", Kind::kSidechain}};

// Words with names behind them.
constexpr KnownWord kNamingWords[] = {
    {"chain", Kind::kChains},         {"resname", Kind::kResidueNames}, {"resn", Kind::kResidueNames},
    {"resid", Kind::kResidueNumbers}, {"resi", Kind::kResidueNumbers},  {"name", Kind::kAtomNames},
    {"element", Kind::kElements},     {"altloc", Kind::kLocations},     {"index", Kind::kIndices}};

// Null: it is none of them.
template <size_t kCount>
const KnownWord *find_word(const KnownWord (&words)[kCount], std::string_view text) {
  const auto *const end = words + kCount;
  const auto *const word = std::find_if(words, end, [&](const KnownWord &known) { return known.text == text; });
  return word == end ? nullptr : word;
}

bool is_joining_word(const std::string &word) { return word == "and" || word == "or"; }

bool is_word(const std::string &word) {
  return find_word(kPlainWords, word) || find_word(kNamingWords, word) || is_joining_word(word) || word == "not" ||
         word == "within" || word == "same";
}

// "" where none is near, and of names in capitals, as residues mostly have.
std::string nearest_selection_word(std::string_view word) {
  if (std::none_of(word.begin(), word.end(), [](char c) { return c >= 'a' && c <= 'z'; })) return "";
  std::vector<std::string> words;
  for (const KnownWord &known : kPlainWords) words.emplace_back(known.text);
  for (const KnownWord &known : kNamingWords) words.emplace_back(known.text);
  for (const char *known : {"not", "within", "same", "and", "or"}) words.push_back(known);
  return nearest_word(std::string(word), words);
}

// What a list of names in CID syntax may consist of: gemmi refuses punctuation but for the comma.
bool is_cid_list(std::string_view text) {
  if (!text.empty() && (text[0] == '!' || text[0] == '*')) text.remove_prefix(1);
  return std::none_of(text.begin(), text.end(), [](char c) {
    return is_blank(c) || std::string_view("[]()!/*-.:;").find(c) != std::string::npos;
  });
}

bool is_name(std::string_view text) {
  return !text.empty() && is_cid_list(text) && text[0] != '!' && text[0] != '*' && text.find(',') == std::string::npos;
}

bool begins_with_digit(std::string_view text) { return !text.empty() && is_digit(text[0]); }

std::shared_ptr<const gemmi::Selection> read_cid(const std::string &cid) {
  auto selection = std::make_shared<gemmi::Selection>(cid);
  // "//A/12" is residue 12; gemmi before 0.6 takes it for "//A/12-", all from 12 on.
  const bool has_range = cid.find('-') < cid.find(';');
  if (!has_range && selection->from_seqid.seqnum != INT_MIN) selection->to_seqid = selection->from_seqid;
  return selection;
}

// -12, 12A and the like. Takes it off the text.
bool read_place(std::string_view &text, ResiduePlace &place) {
  size_t digits = !text.empty() && text[0] == '-' ? 1 : 0;
  while (digits < text.size() && begins_with_digit(text.substr(digits))) ++digits;
  if (!parse_integer(text.substr(0, digits), place.first)) return false;
  text.remove_prefix(digits);
  place.second = ' ';
  if (!text.empty() && is_letter(text[0])) {
    place.second = text[0];
    text.remove_prefix(1);
  }
  return true;
}

class Parser {
 public:
  explicit Parser(const std::string &text) : text_(text) {}

  SelectionTerm parse() {
    SelectionTerm term;
    joined(Kind::kOr, term);
    if (!at_end()) {
      if (text_[at_] == ')') fail_at(at_, "')' closes no '('");
      fail_at(at_, "'and' or 'or' is missing before " + quoted(peek()));
    }
    return term;
  }

 private:
  [[noreturn]] void fail(const std::string &what) const {
    fail_usage("the selection '" + excerpt_of(text_) + "' can't be understood: " + what);
  }
  [[noreturn]] void fail_at(size_t place, const std::string &what) const {
    fail(what + " (at character " + number_of_character(place) + ")");
  }

  // Characters are counted from 1, and may have several bytes.
  std::string number_of_character(size_t place) const {
    const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    return std::to_string(1 + std::count_if(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(place), begins));
  }

  static std::string quoted(std::string_view word) { return "'" + excerpt_of(word) + "'"; }

  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }
  bool at_end() {
    skip_blanks();
    return at_ == text_.size();
  }

  // Up to a blank or a parenthesis, or the parenthesis itself. Empty at the end.
  std::string_view peek() {
    if (at_end()) return {};
    size_t end = at_;
    while (end < text_.size() && !is_blank(text_[end]) && text_[end] != '(' && text_[end] != ')') ++end;
    return std::string_view(text_).substr(at_, std::max<size_t>(1, end - at_));
  }
  std::string_view take() {
    const std::string_view word = peek();
    at_ += word.size();
    return word;
  }
  bool take_word(const char *word) {
    if (lowered(peek()) != word) return false;
    take();
    return true;
  }
  void want_word(const char *word, const char *example) {
    skip_blanks();
    const size_t place = at_;
    if (!take_word(word)) fail_at(place, "'" + std::string(word) + "' is missing, as in " + quoted(example));
  }

  // What calls itself, joined() to parenthesised(), writes terms where they belong and leaves the rest to functions of
  // their own: its frames are small, since callers may have little stack.

  // One of them or several, joined by the word of that kind.
  void joined(Kind kind, SelectionTerm &term) {
    const char *const word = kind == Kind::kOr ? "or" : "and";
    const auto part = [&](SelectionTerm &to) { kind == Kind::kOr ? joined(Kind::kAnd, to) : operand(to); };
    part(term);
    if (!take_word(word)) return;
    become_first_operand(term, kind);
    do part(term.operands.emplace_back());
    while (take_word(word));
  }

  void operand(SelectionTerm &term) {
    check_operand();
    ++depth_;
    if (text_[at_] == '(')
      parenthesised(term);
    else if (take_modifier(term))
      operand(term.operands.emplace_back());
    else
      read_leaf(term);
    --depth_;
  }

  // (HEM) and (!HOH)/CA[C] are CID; (water) is the word, unless residues are called that; other parentheses group.
  void parenthesised(SelectionTerm &term) {
    if (read_flat_parentheses(term)) return;
    const size_t begin = at_++;
    joined(Kind::kOr, term);
    close(begin);
  }

  [[gnu::noinline]] static void become_first_operand(SelectionTerm &term, Kind kind) {
    SelectionTerm first = std::move(term);
    term = SelectionTerm(kind);
    term.operands.push_back(std::move(first));
  }

  [[gnu::noinline]] void check_operand() {
    if (at_end()) fail("something is missing at its end");
    if (depth_ == kDeepest) fail_at(at_, "more than " + std::to_string(kDeepest) + " terms are in each other");
  }

  // Words that stand before the operand they are about.
  [[gnu::noinline]] bool take_modifier(SelectionTerm &term) {
    if (take_word("not")) {
      term.kind = Kind::kNot;
    } else if (take_word("within")) {
      term.kind = Kind::kWithin;
      term.distance = read_distance();
      want_word("of", "within 5 of ligand");
    } else if (take_word("same")) {
      term.kind = Kind::kSameResidue;
      want_word("residue", "same residue as within 5 of ligand");
      want_word("as", "same residue as within 5 of ligand");
    } else {
      return false;
    }
    return true;
  }

  double read_distance() {
    skip_blanks();
    const size_t place = at_;
    const std::string_view number = take();
    double distance = 0;
    if (!parse_number(number, distance) || distance < 0 || distance > kLargestDistance)
      fail_at(place, "'within' wants a distance in Å, as in 'within 5 of ligand'" +
                         (number.empty() ? "" : ", not " + quoted(number)));
    return distance;
  }

  // False, and nothing read, where they group.
  [[gnu::noinline]] bool read_flat_parentheses(SelectionTerm &term) {
    const size_t begin = at_, end = text_.find_first_of("()", begin + 1);
    if (end == std::string::npos) fail_at(begin, "'(' is not closed");
    const std::string_view inside = std::string_view(text_).substr(begin + 1, end - begin - 1);
    if (text_[end] == '(' || inside.empty() || !is_cid_list(inside)) return false;
    const bool ends = end + 1 == text_.size() || is_blank(text_[end + 1]) || text_[end + 1] == ')';
    const KnownWord *const plain = find_word(kPlainWords, lowered(inside));
    if (!ends || !plain) {
      term = cid_from(begin);
      return true;
    }
    at_ = end + 1;
    term.kind = Kind::kLoneResidue;
    term.names.emplace_back(inside);
    term.operands.emplace_back(plain->kind);
    return true;
  }

  [[gnu::noinline]] void close(size_t begin) {
    if (at_end()) fail_at(begin, "'(' is not closed");
    if (text_[at_] != ')') fail_at(at_, "'and' or 'or' is missing before " + quoted(peek()));
    ++at_;
  }

  [[gnu::noinline]] void read_leaf(SelectionTerm &term) { term = leaf(); }

  SelectionTerm leaf() {
    const size_t begin = at_;
    if (text_[at_] == ')') fail_at(at_, "something is missing before ')'");
    const std::string_view raw = take();
    const std::string word = lowered(raw);
    if (is_joining_word(word)) fail_at(begin, "something is missing before " + quoted(raw));
    if (const KnownWord *const plain = find_word(kPlainWords, word)) return SelectionTerm(plain->kind);
    if (const KnownWord *const naming = find_word(kNamingWords, word)) return named(naming->kind, word);
    const bool goes_on = at_ < text_.size() && text_[at_] == '(' && begins_with_digit(raw);  // 10(ALA)
    if (is_name(raw) && !begins_with_digit(raw)) fail_unknown(raw, begin);
    if (goes_on || !is_cid_list(raw) || begins_with_digit(raw) || raw[0] == '!' || raw[0] == '*' ||
        raw.find(',') != std::string::npos)
      return cid_from(begin);
    fail_unknown(raw, begin);
  }

  [[noreturn]] void fail_unknown(std::string_view word, size_t place) const {
    const std::string nearest = nearest_selection_word(word), name = excerpt_of(word);
    fail("'" + name + "' at character " + number_of_character(place) + " is no word of selections; " +
         (nearest.empty() ? "is it a name, as in 'chain " + name + "' or 'resname " + name + "'?"
                          : "did you mean '" + nearest + "'?"));
  }

  // A term in CID syntax: up to a blank, or to a parenthesis that closes none of its own.
  SelectionTerm cid_from(size_t begin) {
    int open = 0;
    for (at_ = begin; at_ < text_.size() && !is_blank(text_[at_]); ++at_) {
      if (text_[at_] == '(') ++open;
      if (text_[at_] == ')' && --open < 0) break;
    }
    SelectionTerm term(Kind::kCid);
    try {
      term.cid = read_cid(text_.substr(begin, at_ - begin));
    } catch (const std::bad_alloc &) {
      throw;
    } catch (const std::exception &error) {
      fail(excerpt_of(error.what()));
    }
    return term;
  }

  // Names up to a word of selections, or to a parenthesis. The first is a name whatever it is, and so is what commas
  // join to others.
  SelectionTerm named(Kind kind, const std::string &word) {
    SelectionTerm term(kind);
    bool is_first = true;
    while (!at_end()) {
      const std::string_view raw = peek();
      const bool is_list = raw.find(',') != std::string::npos;
      if (raw == "(" || raw == ")" || is_joining_word(lowered(raw))) break;
      if (!is_first && !is_list && is_word(lowered(raw))) break;
      const size_t place = at_;
      take();
      for (const std::string &name : split(std::string(raw), ','))
        if (!name.empty()) add_name(term, name, place);
      is_first = false;
    }
    if (term.names.empty() && term.places.empty() && term.indices.empty() && term.elements.empty())
      fail_at(at_, "'" + word + "' wants names behind it, as in '" + word + " " + example_of(kind) + "'");
    return term;
  }

  static const char *example_of(Kind kind) {
    switch (kind) {
      case Kind::kChains:
        return "A B";
      case Kind::kResidueNames:
        return "HEM";
      case Kind::kResidueNumbers:
        return "10-40 52A";
      case Kind::kAtomNames:
        return "CA CB";
      case Kind::kElements:
        return "C N";
      case Kind::kIndices:
        return "0-99";
      default:
        return "A";
    }
  }

  void add_name(SelectionTerm &term, const std::string &name, size_t place) const {
    if (name[0] == '"' || name[0] == '\'')
      fail_at(place, "names are without quotation marks, as in '" + std::string(example_of(term.kind)) + "'");
    std::string_view rest = name;
    if (term.kind == Kind::kResidueNumbers) {
      std::pair<ResiduePlace, ResiduePlace> range;
      const bool has_first = read_place(rest, range.first);
      range.second = range.first;
      const bool is_range = has_first && !rest.empty() && rest[0] == '-';
      if (is_range) rest.remove_prefix(1);
      if (!has_first || (is_range && !read_place(rest, range.second)) || !rest.empty())
        fail_at(place, quoted(name) + " is no residue number, nor a range of them such as 10-40, -5--1 or 52A-52C");
      if (range.second < range.first) fail_at(place, "the range " + quoted(name) + " goes backwards");
      term.places.push_back(range);
    } else if (term.kind == Kind::kIndices) {
      std::pair<int, int> range;
      const size_t dash = name.find('-');
      const bool is_range = dash != std::string::npos;
      if (!begins_with_digit(rest) || !parse_integer(rest.substr(0, dash), range.first) ||
          (is_range &&
           (!begins_with_digit(rest.substr(dash + 1)) || !parse_integer(rest.substr(dash + 1), range.second))))
        fail_at(place, quoted(name) + " is no number of an atom from 0 on, nor a range of them such as 0-99");
      if (!is_range) range.second = range.first;
      if (range.second < range.first) fail_at(place, "the range " + quoted(name) + " goes backwards");
      term.indices.push_back(range);
    } else if (term.kind == Kind::kElements) {
      const gemmi::El element = name.size() <= 2 ? gemmi::find_element(name.c_str()) : gemmi::El::X;
      if (element == gemmi::El::X && lowered(name) != "x") fail_at(place, quoted(name) + " is no element");
      term.elements.push_back(element);
    } else {
      if (term.kind == Kind::kLocations && name.size() != 1)
        fail_at(place, quoted(name) + " is no alternate location, which has one letter");
      term.names.push_back(name);
    }
  }

  const std::string &text_;
  size_t at_ = 0;
  int depth_ = 0;
};

// As it was before there were words; null where it was none, or where words are meant.
std::shared_ptr<const gemmi::Selection> read_whole_cid(const std::string &text) {
  const std::string_view before_semicolon = std::string_view(text).substr(0, text.find(';'));
  if (std::any_of(before_semicolon.begin(), before_semicolon.end(), is_blank)) return nullptr;
  try {
    return read_cid(text);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) {
    return nullptr;
  }
}

}  // namespace

void check_lone_word(const std::string &word) {
  constexpr size_t kShortest = 3;  // a chain is more likely meant by less
  if (is_word(lowered(word)) || (word.size() >= kShortest && !nearest_selection_word(word).empty()))
    Parser(word).parse();  // which tells what is wrong
}

SelectionTerm parse_selection(const std::string &text) {
  SelectionTerm term;
  const bool is_parenthesised = text.size() > 2 && text.front() == '(' && text.back() == ')';
  const std::string inside = is_parenthesised ? text.substr(1, text.size() - 2) : text;
  if (is_name(inside) && !begins_with_digit(inside)) {
    const KnownWord *const plain = find_word(kPlainWords, lowered(inside));
    if (!is_parenthesised || plain) {
      term.kind = is_parenthesised ? Kind::kLoneResidue : Kind::kLoneName;
      term.names.push_back(inside);
      if (plain) term.operands.emplace_back(plain->kind);
      return term;
    }
  }
  term.kind = Kind::kCid;
  term.cid = read_whole_cid(text);
  return term.cid ? term : Parser(text).parse();
}

}  // namespace quickses::io
