// SPDX-License-Identifier: MIT
using System;

namespace QuickSes.Interop
{
    /// <summary>Whether the native library is there and is the one these declarations were written after.</summary>
    internal static class NativeLibraryCheck
    {
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
            reason = PlatformText.Refusal;
            if (reason.Length > 0)
                return false;
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
                reason = PlatformText.NotLoaded(Reason(e));
            }
            catch (BadImageFormatException e)
            {
                reason = $"The native library {Library} is made for another processor architecture or " +
                         $"system than {PlatformText.Name}. {e.Message}";
            }
            catch (EntryPointNotFoundException e)
            {
                reason = $"The native library {Library} that was found is too old, or another one of the " +
                         $"same name. {e.Message}";
            }
            catch (Exception e)
            {
                reason = $"The native library {Library} can't be used on {PlatformText.Name}: {e.Message}";
            }
            return false;
        }

        /// <summary>
        /// The same of quickses_gpu.h, which may change in any release: where it is another one, the rest can be used.
        /// </summary>
        public static bool IsGpuUsable(out string reason)
        {
            if (!IsUsable(out reason))
                return false;
            try
            {
                uint version = NativeMethods.qses_gpu_abi_version();
                if (version == NativeMethods.GpuAbiVersion)
                    return true;
                reason = $"The native library {Library} has version {version} of what keeps meshes on the GPU, but this " +
                         $"package needs {NativeMethods.GpuAbiVersion}: both must come from the same release.";
            }
            catch (EntryPointNotFoundException)
            {
                reason = $"The native library {Library} that was found is too old to keep meshes on the GPU.";
            }
            return false;
        }

        public static void ThrowIfUnusable()
        {
            if (!IsUsable(out string reason))
                throw new QuickSesException(QuickSesStatus.BackendUnavailable, reason);
        }

        // Mono says "assembly:<unknown assembly>" instead of a reason.
        private static string Reason(DllNotFoundException e)
        {
            string asked = e.Message.Contains("<unknown assembly>") ? LibraryProbe.Ask(Library) : "";
            return asked.Length > 0 ? asked : e.Message;
        }
    }
}
