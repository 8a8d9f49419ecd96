// SPDX-License-Identifier: MIT
namespace UnityEngine
{
    public class Material : Object
    {
    }
}
