// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    /// <summary>Whether the native library is there and is the one these declarations were written after.</summary>
    internal static class NativeLibraryCheck
    {
        /// <summary>What "Add package from git URL" takes: the repository of package.json, and its branch of releases.</summary>
        private const string PackageUrl = "https://example.org/quickses-for-unity.git#upm";

        private const string Library = NativeMethods.Library;
        private static volatile bool s_isUsable;

        /// <summary>
        /// Never throws. A failure is looked into again by the next call: the library may have come meanwhile.
        /// </summary>
        public static bool IsUsable(out string reason)
        {
            reason = "";
            if (s_isUsable)
                return true;
            try
            {
                uint version = NativeMethods.qses_abi_version();
                if (version == NativeMethods.AbiVersion)
                    return s_isUsable = true;
                reason = $"The native library {Library} has ABI version {version}, but this package needs " +
                         $"{NativeMethods.AbiVersion}: both must come from the same release.";
            }
            catch (DllNotFoundException e)
            {
                reason = $"The native library {Library} can't be loaded on {Platform()}: it is missing, or " +
                         "made for another system, or something that it needs is missing (Windows and Linux on " +
                         "x86-64 are supported; on Linux, glibc 2.35 or later is needed, as in Ubuntu 22.04). A " +
                         "checkout of the project has none until it is built (Documentation~/building.md). The " +
                         "package with its libraries: Package Manager > + > Add package from git URL > " +
                         $"{PackageUrl} . {e.Message}";
            }
            catch (BadImageFormatException e)
            {
                reason = $"The native library {Library} is made for another processor architecture or " +
                         $"system than {Platform()}. {e.Message}";
            }
            catch (EntryPointNotFoundException e)
            {
                reason = $"The native library {Library} that was found is too old, or another one of the " +
                         $"same name. {e.Message}";
            }
            catch (Exception e)
            {
                reason = $"The native library {Library} can't be used on {Platform()}: {e.Message}";
            }
            return false;
        }

        public static void ThrowIfUnusable()
        {
            if (!IsUsable(out string reason))
                throw new QuickSesException(QuickSesStatus.BackendUnavailable, reason);
        }

        private static string Platform() =>
            $"{RuntimeInformation.OSDescription.Trim()} ({RuntimeInformation.ProcessArchitecture})";
    }
}
