// SPDX-License-Identifier: MIT
using System;
using System.Diagnostics;
using System.IO;

/// <summary>Files of the project, and the C compiler that judges its header.</summary>
internal static class Repository
{
    public static readonly string Root = FindRoot();

    public static string Header =>
        Path.Combine(Root, "NativePlugin", "Source~", "include", "quickses", "quickses.h");

    public static string GpuHeader => Path.Combine(Path.GetDirectoryName(Header), "quickses_gpu.h");

    public static string CrambinPath => Path.Combine(Root, "Tests", "Data~", "1CRN.pdb");

    /// <summary>Compiles C; what the compiler says against it is the exception's message.</summary>
    public static void CompileC(string source, string output, string options = "")
    {
        string file = output + ".c";
        File.WriteAllText(file, source);
        string include = Path.GetDirectoryName(Path.GetDirectoryName(Header));
        Run(Environment.GetEnvironmentVariable("CC") ?? "cc",
            $"-std=c99 -Wall -Werror {options} -I \"{include}\" \"{file}\" -o \"{output}\"");
    }

    /// <summary>Runs a program and gives what it printed.</summary>
    public static string Run(string program, string arguments)
    {
        using Process process = Process.Start(new ProcessStartInfo(program, arguments)
        {
            UseShellExecute = false, // as by default, but on Mono
            RedirectStandardOutput = true,
            RedirectStandardError = true
        });
        System.Threading.Tasks.Task<string> errors = process.StandardError.ReadToEndAsync();
        string printed = process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        if (process.ExitCode != 0)
            throw new InvalidOperationException(
                $"{program} {arguments}\nended with {process.ExitCode}:\n{errors.Result}");
        return printed;
    }

    private static string FindRoot()
    {
        for (string folder = AppContext.BaseDirectory; folder != null; folder = Path.GetDirectoryName(folder))
            if (File.Exists(Path.Combine(folder, "package.json")) &&
                Directory.Exists(Path.Combine(folder, "NativePlugin")))
                return folder;
        throw new DirectoryNotFoundException($"{AppContext.BaseDirectory} is not inside the project");
    }
}

/// <summary>A folder that goes with the test.</summary>
internal sealed class TemporaryFolder : IDisposable
{
    public readonly string Path =
        Directory.CreateDirectory(
            System.IO.Path.Combine(System.IO.Path.GetTempPath(), System.IO.Path.GetRandomFileName())).FullName;

    public string File(string name) => System.IO.Path.Combine(Path, name);

    public void Dispose() => Directory.Delete(Path, recursive: true);
}
