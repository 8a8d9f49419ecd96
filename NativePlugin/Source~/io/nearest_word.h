// SPDX-License-Identifier: MIT
// What a word that nobody knows was probably meant to be.
#pragma once

#include <string>
#include <vector>

namespace quickses::io {

// The known word that differs least, whatever the case: one letter in three may be wrong, left out, too many, or have
// changed places with its neighbour; a beginning of three letters or more will do if it is that of one word only. ""
// where none is near. Of several, the first.
std::string nearest_word(const std::string &word, const std::vector<std::string> &known);

}  // namespace quickses::io
