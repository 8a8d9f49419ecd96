// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Constraints;
using System;

namespace UnityEngine.TestTools.Constraints
{
    /// <summary>Managed memory that the calling thread allocates while a delegate runs.</summary>
    public class AllocatingGCMemoryConstraint : Constraint
    {
        private sealed class Result : ConstraintResult
        {
            private readonly long _bytes;

            public Result(IConstraint constraint, object actual, long bytes) : base(constraint, actual, bytes > 0) =>
                _bytes = bytes;

            public override void WriteMessageTo(MessageWriter writer) =>
                writer.WriteMessageLine("The provided delegate allocated {0} bytes of managed memory.", _bytes);
        }

        public override string Description => "allocates GC memory";

        public override ConstraintResult ApplyTo<TActual>(TActual actual)
        {
            if (actual == null)
                throw new ArgumentNullException(nameof(actual));
            if (!(actual is TestDelegate code))
                throw new ArgumentException($"The actual value must be a TestDelegate but was {actual.GetType()}");
            long before = GC.GetAllocatedBytesForCurrentThread();
            code();
            return new Result(this, actual, GC.GetAllocatedBytesForCurrentThread() - before);
        }

        public override ConstraintResult ApplyTo<TActual>(ActualValueDelegate<TActual> del)
        {
            if (del == null)
                throw new ArgumentNullException(nameof(del));
            long before = GC.GetAllocatedBytesForCurrentThread();
            del();
            return new Result(this, del, GC.GetAllocatedBytesForCurrentThread() - before);
        }
    }

    public static class ConstraintExtensions
    {
        public static AllocatingGCMemoryConstraint AllocatingGCMemory(this ConstraintExpression chain)
        {
            var constraint = new AllocatingGCMemoryConstraint();
            chain.Append(constraint);
            return constraint;
        }
    }

    public class Is : NUnit.Framework.Is
    {
    }
}
