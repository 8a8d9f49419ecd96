// SPDX-License-Identifier: MIT
// Bytes as somebody else might have them: whoever reads them must refuse or read what comes out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>

// The same with one to four changes at random: of a bit, a byte, or a whole number of four bytes; something left out,
// put in twice, or cut off.
inline std::string changed_bytes(std::string bytes, std::mt19937 *random) {
  for (uint32_t changes = 1 + (*random)() % 4; changes > 0 && !bytes.empty(); --changes) {
    const size_t at = (*random)() % bytes.size();
    switch ((*random)() % 7) {
      case 0:
        bytes[at] = static_cast<char>((*random)());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << (*random)() % 8);
        break;
      case 2:
        bytes[at] = static_cast<char>((*random)() % 2 ? 0xff : (*random)() % 2 ? 0x7f : 0);
        break;
      case 3:
        for (size_t i = at / 4 * 4; i < std::min(at / 4 * 4 + 4, bytes.size()); ++i)
          bytes[i] = static_cast<char>((*random)());
        break;
      case 4:
        bytes.resize(at + 1);
        break;
      case 5:
        bytes.erase(at, 1 + (*random)() % 9);
        break;
      default:
        bytes.insert(at, bytes.substr(at / 2, (*random)() % 16));
    }
  }
  return bytes;
}
