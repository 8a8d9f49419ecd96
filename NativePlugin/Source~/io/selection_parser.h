// SPDX-License-Identifier: MIT
// From the text of a selection to its tree.
#pragma once

#include <string>

#include "io/selection.h"

namespace quickses::io {

// text: not empty, without blanks around it. Throws Error (kUsage), naming the word that is wrong and its place.
SelectionTerm parse_selection(const std::string &text);

// For a word alone that names no chain: throws Error (kUsage) if it is meant as a word of selections, but is none or
// not enough. Names in capitals are taken for names.
void check_lone_word(const std::string &word);

}  // namespace quickses::io
