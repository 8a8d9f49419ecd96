// SPDX-License-Identifier: MIT
// Selections in gemmi's CID syntax, such as "//A" or "/1/A/10-40/CA[C]": of the atoms of a file as it is read, and of
// those of a structure afterwards.
#pragma once

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <gemmi/select.hpp>
#include <memory>
#include <string>

namespace quickses::io {

// null for an empty text, which names everything. Throws Error (kUsage): the text can't be understood.
std::unique_ptr<gemmi::Selection> parse_selection(const std::string &cid);

}  // namespace quickses::io
