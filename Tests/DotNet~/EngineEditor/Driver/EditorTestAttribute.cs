// SPDX-License-Identifier: MIT

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// On an assembly: each of its tests begins in edit mode with an empty project, and fails by errors in the log that it
    /// does not expect.
    /// </summary>
    public sealed class EditorTestAttribute : EngineTestAttribute
    {
        protected override void Begin() => EditorDriver.Begin();

        protected override void End() => EditorDriver.End();
    }
}
