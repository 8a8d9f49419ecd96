// SPDX-License-Identifier: MIT
// Stands in for the file of this name: the package needs nothing of it by name.
