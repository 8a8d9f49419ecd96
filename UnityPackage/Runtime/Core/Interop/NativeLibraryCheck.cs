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
