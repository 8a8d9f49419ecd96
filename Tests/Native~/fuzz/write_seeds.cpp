// SPDX-License-Identifier: MIT
// Writes what fuzzing begins with, a folder for each target.   fuzz_seeds FOLDER
#include "fuzz/seeds.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

int main(int argc, char **argv) {
  if (argc != 2) {
    std::fprintf(stderr, "Usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  for (const fuzz::Target &target : fuzz::targets()) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target.name;
    std::filesystem::create_directories(folder);
    for (size_t k = 0; k < target.seeds.size(); ++k)
      std::ofstream(folder / std::to_string(k), std::ios::binary) << target.seeds[k];
  }
  return 0;
}
