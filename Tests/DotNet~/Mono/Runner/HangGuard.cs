// SPDX-License-Identifier: MIT
using System;
using System.Diagnostics;
using System.IO;
using System.Threading;

namespace QuickSes.MonoRunner
{
    /// <summary>Ends the program, with its name, where a test goes on for longer than any does.</summary>
    internal sealed class HangGuard
    {
        private static readonly TimeSpan Limit = TimeSpan.FromMinutes(10);

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
                    Process.GetCurrentProcess().Kill(); // what hangs may hold up an orderly end
                }
            }
        }
    }
}
