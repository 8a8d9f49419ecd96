// SPDX-License-Identifier: MIT
using System;

namespace QuickSes.MonoSupport
{
    internal static class Program
    {
        private static void Main()
        {
            bool isSupported = SurfaceContext.IsSupported(out string reason);
            bool isMade = SurfaceContext.TryCreate(default, out SurfaceContext context, out QuickSesError error);
            context?.Dispose();
            if (isMade != isSupported || error.Message != reason)
                throw new InvalidOperationException($"{isSupported}: {reason}\n{isMade}: {error.Message}");
            Console.WriteLine(isSupported ? "supported" : reason);
        }
    }
}
