// SPDX-License-Identifier: MIT
using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("QuickSes.Core.Tests")]
[assembly: InternalsVisibleTo("QuickSes.Unity")]
[assembly: InternalsVisibleTo("QuickSes.Unity.Tests")]
[assembly: InternalsVisibleTo("QuickSes.Editor.Tests")]
[assembly: InternalsVisibleTo("QuickSes.Playback")]
