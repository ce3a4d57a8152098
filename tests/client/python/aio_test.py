# SPDX-License-Identifier: GPL-3.0-or-later
"""The same with asyncio: several jobs at once, a watch that goes on after a crash."""
import asyncio
import unittest

from anticrack import Case, Error, Geometry, Inclusion, Interface, Load, Mesh, ServerError, Uzawa, aio
from processes import ANTICRACKD, Daemon, FolderTest

GEOMETRY = Geometry([(-1, -1), (1, -1), (1, 1), (-1, 1)], [Interface([(-1, 0), (1, 0)])],
                    [Inclusion("fibre", (-0.5, 0), (0.5, 0), delaminated=True)])
COARSE = Mesh(size=0.2)
ENDLESS = Uzawa(theta=1e-9, epsilon=1e-30, max_iterations=1_000_000)


def case(force, **options):
    return Case(GEOMETRY, [Load("load", force)], COARSE, **options)


class Async(unittest.IsolatedAsyncioTestCase):
    async def test_many_at_once(self):
        async with aio.local(program=ANTICRACKD) as client:
            results = await asyncio.gather(*(client.run(case(f)) for f in (1, 2, 3)))
            energies = [result["load"].energy for result in results]
            self.assertAlmostEqual(energies[2] / energies[0], 9, places=9)
            sweep = (await client.run(case(1), [[1.0], [2.0]])).sweep
            self.assertEqual(sweep.coefficients.tolist(), [[1], [2]])
            self.assertEqual(len(await client.jobs()), 4)
            self.assertGreater(len((await client.mesh_arrays(await client.mesh(case(1))))["nodes"]), 10)
            self.assertIn("uzawa", (await client.info()).features)

    async def test_cancel_and_delete(self):
        async with aio.local(program=ANTICRACKD) as client:
            job = await client.submit(case("y > 0 ? 1 : -1", solver=ENDLESS))
            async for message in job.events():
                if message.HasField("samples"):
                    await job.cancel()
            self.assertEqual(job.state, "cancelled")
            await job.delete()
            with self.assertRaisesRegex(ServerError, "(?i)no job"):
                await client.job(job.name)
        with self.assertRaisesRegex(Error, "this client is closed"):
            await client.info()


class Crash(FolderTest, unittest.IsolatedAsyncioTestCase):
    async def test_a_watch_goes_on(self):
        with Daemon(self.folder) as first:
            async with aio.connect(f"127.0.0.1:{first.port}") as client:
                job = await client.submit(case("y > 0 ? 1 : -1", solver=ENDLESS))
                events = job.events()
                async for message in events:
                    if message.HasField("samples"):
                        break
                first.kill()
                with Daemon(self.folder, port=first.port):
                    async for message in events:
                        if message.HasField("samples") and (await job.refresh()).message.status.attempt == 2:
                            await job.cancel()
                    self.assertEqual((job.state, job.message.status.attempt), ("cancelled", 2))
