// SPDX-License-Identifier: MIT
using System;
using System.Diagnostics;
using System.IO;
using System.Runtime.InteropServices;
using System.Threading;

namespace QuickSes.MonoRunner
{
    /// <summary>
    /// Ends the program where a test goes on for longer than any does: with its name, and where each thread is.
    /// </summary>
    internal sealed class HangGuard
    {
        private static readonly TimeSpan Limit = TimeSpan.FromMinutes(10);

        private const int Quit = 3; // SIGQUIT

        private readonly TextWriter _output;
        private readonly Stopwatch _clock = new Stopwatch(); // locked, as the next one
        private string _test;

        public HangGuard(TextWriter output)
        {
            _output = output;
            new Thread(Watch) { IsBackground = true }.Start();
        }

        public void Begin(string test)
        {
            lock (_clock)
            {
                _test = test;
                _clock.Restart();
            }
        }

        public void End()
        {
            lock (_clock)
                _clock.Reset();
        }

        [DllImport("libc")]
        private static extern int kill(int process, int signal);

        private void Watch()
        {
            while (true)
            {
                Thread.Sleep(1000);
                lock (_clock)
                {
                    if (_clock.Elapsed < Limit)
                        continue;
                    _output.WriteLine($"HANGS {_test}");
                    kill(Process.GetCurrentProcess().Id, Quit); // Mono prints the stack of each thread
                    Thread.Sleep(5000);
                    Process.GetCurrentProcess().Kill(); // what hangs may hold up an orderly end
                }
            }
        }
    }
}
