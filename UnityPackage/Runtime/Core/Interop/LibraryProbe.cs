// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.ComponentModel;
using System.IO;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    /// <summary>
    /// Asks the system's loader itself why a library can't be loaded: Mono keeps that to itself. Nothing here throws.
    /// </summary>
    internal static class LibraryProbe
    {
        /// <summary>The loader's reason for the package's library, with the file's name; "" if it gives none.</summary>
        public static string Ask(string library)
        {
#if UNITY_EDITOR || UNITY_STANDALONE || !UNITY_2021_3_OR_NEWER
            try
            {
                bool isWindows = RuntimeInformation.IsOSPlatform(OSPlatform.Windows);
                string file = isWindows ? library + ".dll" : $"lib{library}.so";
                foreach (string folder in Folders(isWindows))
                    if (File.Exists(Path.Combine(folder, file)))
                        return AskAbout(Path.Combine(folder, file));
                return AskAbout(file); // somewhere on the loader's own path, or nowhere
            }
            catch (Exception)
            {
                return ""; // not even the loader can be asked
            }
#else
            return ""; // elsewhere there is no library to ask about
#endif
        }

#if UNITY_EDITOR || UNITY_STANDALONE || !UNITY_2021_3_OR_NEWER

        /// <summary>The same for one file.</summary>
        public static string AskAbout(string file)
        {
            try
            {
                string architecture = File.Exists(file) ? OtherArchitecture(file) : "";
                if (architecture.Length > 0)
                    return $"{file} is made for {architecture}, and this process is {RuntimeInformation.ProcessArchitecture}";
                return RuntimeInformation.IsOSPlatform(OSPlatform.Windows) ? AskWindows(file) : AskLinux(file);
            }
            catch (Exception)
            {
                return "";
            }
        }

        /// <summary>The processor that a library is made for, if it is another one than this process runs on; else "".</summary>
        public static string OtherArchitecture(string file)
        {
            var header = new byte[4096];
            using (FileStream stream = File.OpenRead(file))
                if (stream.Read(header, 0, header.Length) < 64)
                    return "";
            Architecture? machine = null;
            if (header[0] == 0x7f && header[1] == 'E' && header[2] == 'L' && header[3] == 'F')
            {
                machine = MachineOfElf(BitConverter.ToUInt16(header, 18));
            }
            else if (header[0] == 'M' && header[1] == 'Z')
            {
                int start = BitConverter.ToInt32(header, 60);
                if (start >= 0 && start <= header.Length - 6)
                    machine = MachineOfPe(BitConverter.ToUInt16(header, start + 4));
            }
            return machine == null || machine == RuntimeInformation.ProcessArchitecture ? "" : machine.ToString();
        }

        private static Architecture? MachineOfElf(ushort machine) => machine switch
        {
            3 => Architecture.X86, 40 => Architecture.Arm, 62 => Architecture.X64, 183 => Architecture.Arm64, _ => null
        };

        private static Architecture? MachineOfPe(ushort machine) => machine switch
        {
            0x14c => Architecture.X86, 0x1c4 => Architecture.Arm, 0x8664 => Architecture.X64,
            0xaa64 => Architecture.Arm64, _ => null
        };

        // Where Unity puts it: beside a player's data, for Mono and for IL2CPP, and in the package itself in the Editor.
        private static IEnumerable<string> Folders(bool isWindows)
        {
            string assembly = FolderOf(typeof(LibraryProbe).Assembly.Location);
            string program = Environment.GetCommandLineArgs()[0];
            string data = Path.Combine(FolderOf(program), Path.GetFileNameWithoutExtension(program) + "_Data", "Plugins");
            string players = Path.Combine(assembly, "..", "Plugins");
            yield return assembly;
            yield return players;
            yield return Path.Combine(players, "x86_64");
            yield return data;
            yield return Path.Combine(data, "x86_64");
#if UNITY_EDITOR
            yield return Path.Combine(FolderOf(ThisFile()), "..", "..", "..", "Plugins",
                isWindows ? "windows-x86_64" : "linux-x86_64");
#endif
        }

        private static string FolderOf(string file) =>
            string.IsNullOrEmpty(file) ? "" : Path.GetDirectoryName(Path.GetFullPath(file));

        private static string ThisFile([CallerFilePath] string path = "") => path;

        private static string AskLinux(string file)
        {
            const int now = 2;
            dlerror(); // found by the runtime now, which loads a library for that: in between it would forget the reason
            IntPtr library = dlopen(file, now);
            if (library == IntPtr.Zero)
                return Marshal.PtrToStringAnsi(dlerror()) ?? "";
            dlclose(library);
            return $"{file} itself can be loaded";
        }

        private static string AskWindows(string file)
        {
            IntPtr library = LoadLibraryW(file);
            if (library == IntPtr.Zero)
            {
                int error = Marshal.GetLastWin32Error();
                // 126: the file, or one that it needs, was not found; which, Windows does not tell.
                string what = error == 126 && File.Exists(file) ? ": a library that it needs is missing" : "";
                return $"{file}: {new Win32Exception(error).Message}{what}";
            }
            FreeLibrary(library);
            return $"{file} itself can be loaded";
        }

        [DllImport("libdl.so.2")]
        private static extern IntPtr dlopen(string file, int mode);

        [DllImport("libdl.so.2")]
        private static extern IntPtr dlerror();

        [DllImport("libdl.so.2")]
        private static extern int dlclose(IntPtr library);

        [DllImport("kernel32", CharSet = CharSet.Unicode, SetLastError = true)]
        private static extern IntPtr LoadLibraryW(string file);

        [DllImport("kernel32")]
        private static extern int FreeLibrary(IntPtr library);
#endif
    }
}
