"""switch_proxy.py FILE: a TCP proxy. Each new connection goes to the port of 127.0.0.1 that FILE names at that moment;
open connections stay where they are. Prints its own port.
"""
import asyncio
import sys


async def relay(reader, writer):
    try:
        while data := await reader.read(65536):
            writer.write(data)
            await writer.drain()
    except OSError:
        pass
    writer.close()


async def serve(reader, writer):
    try:
        with open(sys.argv[1], encoding="ascii") as file:
            server_reader, server_writer = await asyncio.open_connection("127.0.0.1", int(file.read()))
    except OSError:
        writer.close()
        return
    await asyncio.gather(relay(reader, server_writer), relay(server_reader, writer))


async def main():
    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    print(server.sockets[0].getsockname()[1], flush=True)
    await server.serve_forever()


asyncio.run(main())
