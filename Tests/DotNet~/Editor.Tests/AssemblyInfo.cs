// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

[assembly: EditorTest]
