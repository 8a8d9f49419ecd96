// SPDX-License-Identifier: MIT
namespace QuickSes.Editor
{
    /// <summary>
    /// How the inspector shows the serialised fields of a <see cref="MolecularSurface"/>. Decisions only: no Editor in
    /// here.
    /// </summary>
    internal static class SurfaceForm
    {
        /// <summary>The unit of a field; null: none.</summary>
        public static string UnitOf(string property)
        {
            switch (property)
            {
                case "_probeRadius":
                case "_spacing":
                case "_levels":
                    return "Å";
                case "_frameBudget":
                    return "ms";
                case "_restDelay":
                    return "s";
                default:
                    return null;
            }
        }

        /// <summary>Whether a field of a surface of that kind, made by that method, changes anything.</summary>
        public static bool IsUsed(string property, SurfaceKind surface, SurfaceMethod method)
        {
            switch (property)
            {
                case "_probeRadius":
                    return surface == SurfaceKind.Ses || surface == SurfaceKind.Sas;
                case "_method":
                    return surface == SurfaceKind.Ses;
                case "_sharpCreases":
                    return surface != SurfaceKind.Gaussian &&
                        (surface != SurfaceKind.Ses || method != SurfaceMethod.Grid);
                case "_relaxationSteps":
                    return surface != SurfaceKind.Gaussian;
                case "_gaussianRadiusScale":
                case "_gaussianIsovalue":
                    return surface == SurfaceKind.Gaussian;
                default:
                    return true;
            }
        }
    }
}
