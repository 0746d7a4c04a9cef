import { decodeFrame, decodeHeader, decodeTopology, FRAME, TOPOLOGY } from './protocol';
import type { Command, SceneMessage, TextMessage, Topology } from './protocol';
import type { Source, SourceListener } from './source';

const FIRST_RETRY_MS = 500;
const LAST_RETRY_MS = 3000;

/** The server's WebSocket. Connects again by itself. */
export class Connection implements Source {
  private socket: WebSocket | null = null;
  private listener: SourceListener | null = null;
  private retryMs = FIRST_RETRY_MS;
  private readonly scenes = new Map<number, SceneMessage>();
  private readonly topologies = new Map<number, { generation: number; topology: Topology }>();

  start(listener: SourceListener): void {
    this.listener = listener;
    this.connect();
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  private connect(): void {
    const token = new URLSearchParams(location.search).get('token') ?? '';
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/live?token=${encodeURIComponent(token)}`);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.retryMs = FIRST_RETRY_MS;
      this.scenes.clear();
      this.topologies.clear();
      this.listener?.connected(true);
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = () => {
      this.socket = null;
      this.listener?.connected(false);
      void this.probe();
      setTimeout(() => this.connect(), this.retryMs);
      this.retryMs = Math.min(1.5 * this.retryMs, LAST_RETRY_MS);
    };
    this.socket = socket;
  }

  /** Tells why there is no connection: a program that was started again has another token, and refuses this one. */
  private async probe(): Promise<void> {
    const refused = await fetch(location.href, { cache: 'no-store' }).then(({ status }) => status === 403, () => false);
    if (!this.socket || this.socket.readyState !== WebSocket.OPEN) this.listener?.lost(refused);
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data === 'string') {
      const message = JSON.parse(data) as TextMessage;
      if (message.type === 'scene') this.scenes.set(message.run, message);
      this.listener?.text(message);
      return;
    }
    const header = decodeHeader(data);
    const scene = this.scenes.get(header.run);
    if (!scene || scene.generation !== header.generation) return;
    if (header.kind === TOPOLOGY) {
      const topology = decodeTopology(data);
      this.topologies.set(header.run, { generation: header.generation, topology });
      this.listener?.topology(header, topology);
    } else if (header.kind === FRAME) {
      const known = this.topologies.get(header.run);
      if (known?.generation === header.generation) {
        this.listener?.frame(header, decodeFrame(data, header, scene, known.topology));
      }
    }
  }
}
